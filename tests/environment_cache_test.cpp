// Environments that are kept: the same again, and never anything else.
#include <catch2/catch.hpp>

#include <atomic>
#include <chrono>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <thread>

#include "obscura/engine/content_cache.h"
#include "obscura/engine/environment_cache.h"
#include "obscura/engine/image_file.h"
#include "temporary_folder.h"

using namespace obscura;
using engine::Environment;
using Parts = engine::EnvironmentParts;
using Projection = engine::EnvironmentProjection;
using Bytes = std::vector<uint8_t>;
using Words = std::vector<std::string>;

namespace {

struct Place {
  TemporaryFolder folder;
  std::string map = folder / "map.pfm", cache = folder / "cache";

  Place() { write(2); }
  void write(float value) const {
    engine::Image image(16, 8, 3, engine::Format::F32);
    for (int k = 0; k < 16 * 8 * 3; ++k) image.row<float>(0)[k] = value + float(k % 7);
    image.row<float>(0)[0] = -1;
    REQUIRE(engine::writeFileAtomically(map, *engine::encodeImage(engine::FileFormat::Pfm, {{"color", {"R", "G", "B"}, image}})).ok());
  }
  Environment read(Parts parts = Parts::Reflections, Projection p = Projection::Latlong) const {
    auto e = engine::readEnvironment(map, p, parts, 2, cache);
    REQUIRE(e.ok());
    return std::move(*e);
  }
  std::vector<std::string> files() const {
    std::vector<std::string> all;
    if (std::filesystem::exists(cache))
      for (const auto& f : std::filesystem::directory_iterator(cache)) all.push_back(f.path().string());
    return all;
  }
  engine::EnvironmentCache kept(Parts parts = Parts::Reflections) const {
    return {cache, *engine::readImageBytes(map), Projection::Latlong, parts};
  }
};

bool same(const Environment& a, const Environment& b) {
  return a.harmonics == b.harmonics && a.clamped == b.clamped && a.cubes.sides == b.cubes.sides && a.cubes.texels == b.cubes.texels;
}

Bytes bytesOf(const std::string& file) {
  const std::string all = contentOf(file);
  return Bytes(all.begin(), all.end());
}
void put(const std::string& file, const Bytes& bytes) {
  std::ofstream(file, std::ios::binary).write(reinterpret_cast<const char*>(bytes.data()), std::streamsize(bytes.size()));
}

}  // namespace

TEST_CASE("environment cache: what comes from it is what was made, bit for bit, for all parts") {
  const Place p;
  for (Parts parts : {Parts::Light, Parts::Background, Parts::Reflections}) {
    const Environment made = *engine::readEnvironment(p.map, Projection::Latlong, parts, 2);
    CHECK(same(p.read(parts), made));
    REQUIRE(p.kept(parts).load());
    CHECK(same(*p.kept(parts).load(), made));
    CHECK(same(p.read(parts), made));
    CHECK(made.clamped == 1);
  }
  CHECK(p.files().size() == 3);
}

TEST_CASE("environment cache: another map, projection or part is another file, and without a folder nothing is written") {
  const Place p;
  REQUIRE(engine::readEnvironment(p.map, Projection::Latlong, Parts::Light, 1).ok());
  CHECK(p.files().empty());
  p.read();
  p.write(3);
  CHECK_FALSE(p.kept().load());
  p.read();
  CHECK(p.files().size() == 2);
}

TEST_CASE("environment cache: a file that is cut, longer or differs in any part is ignored and written again") {
  const Place p;
  const Environment made = p.read(Parts::Background);
  const std::string file = p.files().at(0);
  const Bytes whole = bytesOf(file);
  std::vector<Bytes> broken = {{}, {'x'}, Bytes(whole.begin(), whole.end() - 1), Bytes(whole.begin(), whole.begin() + 60), whole};
  broken.back().push_back(0);
  for (size_t k = 0; k < whole.size(); k += k < 200 ? 23 : whole.size() / 9) broken.push_back(whole), broken.back()[k] ^= 4;
  for (const Bytes& bytes : broken) {
    put(file, bytes);
    CHECK_FALSE(p.kept(Parts::Background).load());
    CHECK(same(p.read(Parts::Background), made));
    CHECK(bytesOf(file) == whole);
  }
}

TEST_CASE("environment cache: values that cannot be are refused though the checksum is right") {
  const Place p;
  p.read();
  const Bytes whole = bytesOf(p.files().at(0));
  const size_t lines = 2;  // of the title; the second ends with the checksum
  size_t start = 0;
  for (size_t line = 0; line < lines; ++line) start = size_t(std::find(whole.begin() + long(start), whole.end(), '\n') - whole.begin()) + 1;
  const std::string title(whole.begin(), whole.begin() + long(start) - 34);
  const Bytes payload(whole.begin() + long(start), whole.end());
  const size_t sides = sizeof(engine::Harmonics) + 8, texels = sides + 4 * post::kRoughnessLevels;
  const auto with = [&](size_t at, auto value) {
    Bytes b = payload;
    std::memcpy(b.data() + at, &value, sizeof value);
    return b;
  };
  const float nan = std::numeric_limits<float>::quiet_NaN();
  std::vector<Bytes> hostile = {with(sides, int32_t(-1)), with(sides, int32_t(0)), with(sides, int32_t(2147483647)), with(sides, int32_t(8192)),
                                with(texels, nan), with(texels + 4, -1.f), with(payload.size() - 4, 1e38f), with(8, double(nan)), {}, Bytes(sides)};
  for (const Bytes& bytes : hostile) {
    REQUIRE(engine::storeCached(p.files().at(0), title, bytes).ok());
    CHECK_FALSE(p.kept().load());
  }
  REQUIRE(engine::storeCached(p.files().at(0), title, payload).ok());
  CHECK(p.kept().load());
}

TEST_CASE("environment cache: a folder that cannot be made is no error") {
  Place p;
  p.cache = p.map + "/cache";  // below a file
  const Environment made = *engine::readEnvironment(p.map, Projection::Latlong, Parts::Background, 2);
  CHECK(same(p.read(Parts::Background), made));
}

namespace {

// Files of 1000 bytes each that were used so many hours ago.
std::string kept(const TemporaryFolder& folder, char digit, int hours) {
  const std::string file = folder / ("kind-" + std::string(32, digit) + ".bin");
  REQUIRE(engine::storeCached(file, "kind", Bytes(1000 - 4 - 34, uint8_t(digit))).ok());
  REQUIRE(std::filesystem::file_size(file) == 1000);
  std::filesystem::last_write_time(file, std::filesystem::file_time_type::clock::now() - std::chrono::hours(hours));
  return file;
}

}  // namespace

TEST_CASE("content cache: beyond its size what was used the longest ago goes, and nothing that is not its own") {
  const TemporaryFolder folder;
  const std::string oldest = kept(folder, 'a', 9), read = kept(folder, 'b', 8), older = kept(folder, 'c', 7), young = kept(folder, 'd', 1);
  Words others;
  for (const char* name : {"notes.bin", "kind-0.bin", "kind-00000000000000000000000000000000.txt", "-00000000000000000000000000000000.bin", "kind-0000000000000000000000000000000g.bin"}) {
    others.push_back(folder / name);
    put(others.back(), Bytes(5000));
    std::filesystem::last_write_time(others.back(), std::filesystem::file_time_type::clock::now() - std::chrono::hours(99));
  }
  CHECK(engine::loadCached(read, "kind", 1000));  // used now
  const std::string added = folder / ("kind-" + std::string(32, 'e') + ".bin");
  REQUIRE(engine::storeCached(added, "kind", Bytes(966), 3100).ok());
  CHECK_FALSE(std::filesystem::exists(oldest));
  CHECK_FALSE(std::filesystem::exists(older));
  for (const std::string& file : {read, young, added}) CHECK(std::filesystem::exists(file));
  for (const std::string& file : others) CHECK(std::filesystem::exists(file));
  REQUIRE(engine::storeCached(added, "kind", Bytes(2000), 1000).ok());  // larger than all that may be: alone
  for (const std::string& file : {read, young}) CHECK_FALSE(std::filesystem::exists(file));
  CHECK(engine::loadCached(added, "kind", 2000));
}

TEST_CASE("content cache: many that read, write and delete at once see whole files or none") {
  const TemporaryFolder folder;
  std::atomic<int> wrong{0}, found{0};
  std::vector<std::thread> users;
  for (int user = 0; user < 4; ++user)
    users.emplace_back([&, user] {
      for (int k = 0; k < 60; ++k) {
        const char digit = char('a' + (k + user) % 6);
        const std::string file = folder / ("kind-" + std::string(32, digit) + ".bin");
        if (const auto bytes = engine::loadCached(file, "kind", 3000)) ++found, wrong += bytes->size() != 2000 || bytes->front() != uint8_t(digit) || bytes->back() != uint8_t(digit);
        else wrong += !engine::storeCached(file, "kind", Bytes(2000, uint8_t(digit)), 6200).ok();
      }
    });
  for (std::thread& user : users) user.join();
  CHECK(wrong == 0);
  CHECK(found > 0);
  CHECK(folder.files() <= 6);
}
