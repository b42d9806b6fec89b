#include "obscura/apps/report.h"

#include <cstdio>
#include <sstream>
#include <utility>

#include "obscura/apps/pictures.h"
#include "obscura/engine/digest.h"
#include "obscura/raster/parallel.h"

namespace obscura::apps {
namespace {

using Entries = std::vector<std::pair<const char*, std::string>>;

Entries statisticsOf(const raster::Statistics& s, const post::TransferStatistics* t, const engine::LightStatistics* l) {
  const auto n = [](uint64_t v) { return std::to_string(v); };
  Entries e{{"instances", n(s.instances)},
          {"instances_culled", n(s.instancesCulled)},
          {"instances_hidden", n(s.instancesHidden)},
          {"clusters", n(s.clusters)},
          {"clusters_culled", n(s.clustersCulled)},
          {"clusters_hidden", n(s.clustersHidden)},
          {"triangles", n(s.triangles)},
          {"triangles_culled", n(s.trianglesCulled)},
          {"triangles_facing_away", n(s.facingAway)},
          {"triangles_outside", n(s.outside)},
          {"triangles_hidden", n(s.hidden)},
          {"triangles_clipped", n(s.clipped)},
          {"triangles_invalid", n(s.invalid)},
          {"triangles_drawn", n(s.drawn)},
          {"tiles", n(s.tiles)},
          {"tiles_empty", n(s.tilesEmpty)}};
  if (t) {
    e.emplace_back("transfer_pixels_unasked", n(t->unasked));
    e.emplace_back("transfer_pixels_empty", n(t->empty));
    e.emplace_back("transfer_pixels_open", n(t->open));
    e.emplace_back("transfer_pixels_sampled", n(t->sampled));
  }
  if (l) {
    e.emplace_back("lights", n(l->lights));
    e.emplace_back("lights_unseen", n(l->unseen));
    e.emplace_back("shadow_maps", n(l->shadowMaps));
  }
  return e;
}

Entries timingsOf(const engine::FrameTimings& f, const RunTimings& r) {
  const auto ms = [](double v) {
    char text[32];
    std::snprintf(text, sizeof text, "%.3f", v);
    return std::string(text);
  };
  return {{"load_ms", ms(r.load)},     {"environment_ms", ms(r.environment)}, {"gbuffer_ms", ms(f.gbuffer)}, {"shadows_ms", ms(f.shadows)}, {"direct_ms", ms(f.direct)}, {"transfer_ms", ms(f.transfer)},
          {"filter_ms", ms(f.filter)}, {"light_ms", ms(f.light)},     {"downsample_ms", ms(f.downsample)},
          {"display_ms", ms(f.display)}, {"frame_ms", ms(f.frame)},   {"digest_ms", ms(r.digest)},
          {"encode_ms", ms(r.encode)}, {"write_ms", ms(r.write)}};
}

std::string jsonObject(const Entries& entries) {
  std::string s;
  for (const auto& [name, value] : entries) s += std::string(s.empty() ? "" : ", ") + "\"" + name + "\": " + value;
  return "{" + s + "}";
}

// "NAME WxHxC TYPE HASH"; none of the four needs escaping.
std::string jsonDigest(const std::string& line) {
  std::istringstream words(line);
  std::string name, size, type, hash;
  words >> name >> size >> type >> hash;
  return "{\"name\": \"" + name + "\", \"size\": \"" + size + "\", \"type\": \"" + type + "\", \"hash\": \"" + hash +
         "\"}";
}

// One line, whatever a file's names hold.
void printLine(const char* kind, std::string message) {
  for (char& c : message)
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7F) c = ' ';
  std::fprintf(stderr, "obscura: %s: %s\n", kind, message.c_str());
}

}  // namespace

void printWarning(const std::string& message) { printLine("warning", message); }

int fail(const engine::Error& error) {
  printLine("error", error.text());
  switch (error.code) {
    case engine::ErrorCode::Usage: return kUsage;
    case engine::ErrorCode::BadInput: return kBadInput;
    case engine::ErrorCode::CannotWrite: break;
  }
  return kCannotWrite;
}

std::vector<std::string> digestLines(const engine::Frame& frame, const std::vector<engine::Aov>& aovs, int threads) {
  std::vector<std::pair<std::string, engine::RowSource>> sources;
  for (engine::Aov aov : aovs) {
    sources.emplace_back(engine::infoOf(aov).name, planeRows(frame, aov));
    if (aov == engine::Aov::Color) sources.emplace_back("display", displayRows(frame));
  }
  std::vector<std::string> lines(sources.size());
  raster::Parallel(threads).forRanges(lines.size(), 1, [&](size_t begin, size_t end, int) {
    for (size_t i = begin; i < end; ++i) lines[i] = engine::digestLine(sources[i].first, sources[i].second);
  });
  return lines;
}

std::string textOf(const Report& report) {
  std::string s;
  for (const std::string& line : report.digests) s += line + "\n";
  Entries entries;
  if (report.statistics) entries = statisticsOf(*report.statistics, report.transfer, report.lights);
  if (report.frame && report.run)
    for (auto& entry : timingsOf(*report.frame, *report.run)) entries.push_back(std::move(entry));
  for (const auto& [name, value] : entries) s += std::string(name) + " " + value + "\n";
  return s;
}

std::string jsonOf(const Report& report) {
  Entries parts;
  std::string digests;
  for (const std::string& line : report.digests) digests += (digests.empty() ? "" : ", ") + jsonDigest(line);
  if (!report.digests.empty()) parts.emplace_back("digests", "[" + digests + "]");
  if (report.statistics)
    parts.emplace_back("statistics", jsonObject(statisticsOf(*report.statistics, report.transfer, report.lights)));
  if (report.frame && report.run) parts.emplace_back("timings", jsonObject(timingsOf(*report.frame, *report.run)));
  return jsonObject(parts) + "\n";
}

}  // namespace obscura::apps
