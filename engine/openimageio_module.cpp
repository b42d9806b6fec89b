// obscura_openimageio.so: the only file that includes OpenImageIO.
#include "obscura/engine/openimageio_module.h"

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <exception>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

namespace {

using OIIO::ImageInput;
using OIIO::ImageOutput;
using OIIO::ImageSpec;
using OIIO::TypeDesc;

constexpr int kRowsAtOnce = 64;  // a multiple of the 16 rows of a ZIP block
const char* const kColorLayer = "color";
const char* const kCompression = "zip";

struct Failure {
  std::string text;
};

// Runs `body`, which returns nothing and throws Failure or anything else. The text loses its line breaks.
template <class F>
int report(char* error, size_t errorSize, const F& body) noexcept {
  const auto say = [&](const char* text) {
    std::snprintf(error, errorSize, "%s", text);
    for (char* c = error; *c; ++c)
      if (static_cast<unsigned char>(*c) < ' ') *c = ' ';
    return 1;
  };
  try {
    body();
    return 0;
  } catch (const Failure& f) {
    return say(f.text.c_str());
  } catch (const std::exception& e) {
    return say(e.what());
  } catch (...) {
    return say("unknown failure");
  }
}

// By content, so that a wrong or missing extension does not matter and no plug-in is tried that was not meant
// (movies, raw cameras, fonts): a file is hostile. By extension only what has no magic number.
std::string formatOf(std::string_view file, std::string_view name) {
  struct Magic {
    size_t at;
    std::string_view bytes;
    const char* format;
  };
  static constexpr Magic kMagics[] = {
      {0, {"\x76\x2f\x31\x01", 4}, "openexr"}, {0, "#?", "hdr"},
      {0, {"II*\0", 4}, "tiff"},               {0, {"MM\0*", 4}, "tiff"},
      {0, {"II+\0", 4}, "tiff"},               {0, {"MM\0+", 4}, "tiff"},
      {0, "BM", "bmp"},                        {8, "WEBP", "webp"},
      {0, "GIF8", "gif"},                      {0, "DDS ", "dds"},
      {4, "jP  ", "jpeg2000"},                 {0, "\xff\x4f\xff\x51", "jpeg2000"},
      {0, "SDPX", "dpx"},                      {0, "XPDS", "dpx"},
      {0, "8BPS", "psd"},                      {0, "P1", "pnm"},
      {0, "P2", "pnm"},                        {0, "P3", "pnm"},
      {0, "P4", "pnm"},                        {0, "P5", "pnm"},
      {0, "P6", "pnm"},
  };
  for (const Magic& m : kMagics)
    if (file.size() > m.at && file.substr(m.at, m.bytes.size()) == m.bytes) return m.format;
  const size_t dot = name.rfind('.');
  std::string extension(dot == name.npos ? "" : name.substr(dot + 1));
  for (char& c : extension)
    if (c >= 'A' && c <= 'Z') c = char(c - 'A' + 'a');
  return extension == "tga" ? "targa" : "";
}

int32_t formatFrom(TypeDesc type) {
  switch (type.basetype) {
    case TypeDesc::UINT8: return kObscuraU8;
    case TypeDesc::UINT16: return kObscuraU16;
    case TypeDesc::UINT32: return kObscuraU32;
    default: return kObscuraF32;
  }
}

TypeDesc typeFrom(int32_t format) {
  switch (format) {
    case kObscuraU8: return TypeDesc::UINT8;
    case kObscuraU16: return TypeDesc::UINT16;
    case kObscuraU32: return TypeDesc::UINT32;
    default: return TypeDesc::FLOAT;
  }
}

struct Group {
  std::string layer;
  std::vector<std::string> channels;
  int first = 0;
  TypeDesc type;
  void* data = nullptr;
};

// Runs of channels "layer.channel" of the same layer and format. Channels without a layer are the layer "color".
std::vector<Group> groupsOf(const ImageSpec& spec) {
  std::vector<Group> groups;
  for (int c = 0; c < spec.nchannels; ++c) {
    const std::string full = spec.channel_name(c);
    const size_t dot = full.rfind('.');
    const std::string layer = dot == full.npos ? kColorLayer : full.substr(0, dot);
    const std::string channel = dot == full.npos ? full : full.substr(dot + 1);
    const TypeDesc type = typeFrom(formatFrom(spec.channelformat(c)));
    if (groups.empty() || groups.back().layer != layer || groups.back().type != type)
      groups.push_back({layer, {}, c, type, nullptr});
    groups.back().channels.push_back(channel);
  }
  return groups;
}

std::vector<const char*> pointers(const std::vector<std::string>& names) {
  std::vector<const char*> p;
  for (const std::string& n : names) p.push_back(n.c_str());
  return p;
}

void decodeFile(const void* file, size_t size, const char* name, const ObscuraLayerSink& sink) {
  const std::string format = formatOf({static_cast<const char*>(file), size}, name);
  if (format.empty()) throw Failure{"not an image in a known format"};
  OIIO::Filesystem::IOMemReader reader(file, size);
  const std::unique_ptr<ImageInput> in = ImageInput::create(format);
  if (!in) throw Failure{"cannot read " + format + ": " + OIIO::geterror()};
  if (!in->supports("ioproxy")) throw Failure{"cannot read " + format + " from memory"};
  ImageSpec config, spec;
  config.attribute("oiio:UnassociatedAlpha", 1);
  config.attribute("oiio:RawColor", 1);
  in->set_ioproxy(&reader);
  if (!in->open(name, spec, config)) throw Failure{"broken " + format + ": " + in->geterror()};
  if (spec.deep || spec.depth > 1) throw Failure{"deep and volume images are not supported"};
  std::vector<Group> groups = groupsOf(spec);
  for (Group& g : groups) {
    const std::vector<const char*> names = pointers(g.channels);
    const ObscuraLayer layer{g.layer.c_str(), names.data(),         spec.width, spec.height,
                             int32_t(names.size()), formatFrom(g.type), nullptr};
    g.data = sink.layer(sink.user, &layer);
    if (!g.data) throw Failure{"stopped"};
  }
  for (const Group& g : groups)
    if (!in->read_image(0, 0, g.first, g.first + int(g.channels.size()), g.type, g.data))
      throw Failure{"broken " + format + ": " + in->geterror()};
}

// All channels of all layers, 4 bytes each, interleaved as OpenEXR's scan lines want them.
void writeExr(ImageOutput& out, const ObscuraLayer* layers, size_t layerCount) {
  const size_t width = size_t(layers[0].width);
  size_t channels = 0;
  for (size_t i = 0; i < layerCount; ++i) channels += size_t(layers[i].channels);
  std::vector<uint32_t> rows(width * channels * kRowsAtOnce);
  for (int y = 0; y < layers[0].height; y += kRowsAtOnce) {
    const int end = std::min(y + kRowsAtOnce, layers[0].height);
    size_t first = 0;
    for (size_t i = 0; i < layerCount; ++i) {
      const size_t n = size_t(layers[i].channels), count = width * size_t(end - y);
      const auto* from = static_cast<const uint32_t*>(layers[i].data) + size_t(y) * width * n;
      for (size_t p = 0; p < count; ++p) std::memcpy(&rows[p * channels + first], from + p * n, n * 4);
      first += n;
    }
    if (!out.write_scanlines(out.spec().y + y, out.spec().y + end, 0, TypeDesc::UNKNOWN, rows.data())) throw Failure{out.geterror()};
  }
}

void encodeFile(const char* name, const ObscuraLayer* layers, size_t layerCount, const ObscuraPlacement& place,
                const ObscuraByteSink& sink) {
  const std::unique_ptr<ImageOutput> out = ImageOutput::create(name);
  if (!out) throw Failure{"OpenImageIO cannot write this format: " + OIIO::geterror()};
  if (!out->supports("ioproxy")) throw Failure{std::string(out->format_name()) + " cannot be written to memory"};
  std::vector<unsigned char> bytes;
  OIIO::Filesystem::IOVecOutput writer(bytes);
  const bool exr = std::string_view(out->format_name()) == "openexr";
  ImageSpec spec(layers[0].width, layers[0].height, layers[0].channels, typeFrom(layers[0].format));
  if (exr) {
    spec.nchannels = 0;
    spec.channelnames.clear();
    for (size_t i = 0; i < layerCount; ++i)
      for (int c = 0; c < layers[i].channels; ++c) {
        const std::string layer = layers[i].name;
        spec.channelnames.push_back((layer == kColorLayer ? "" : layer + ".") + layers[i].channelNames[c]);
        spec.channelformats.push_back(typeFrom(layers[i].format));
        ++spec.nchannels;
      }
    spec.x = place.x, spec.y = place.y;
    spec.full_width = place.imageWidth, spec.full_height = place.imageHeight;
    spec.attribute("compression", kCompression);
  }
  spec.attribute("DateTime", "1970:01:01 00:00:00");  // else the clock's: the same image is the same file
  out->set_ioproxy(&writer);
  if (!out->open(name, spec)) throw Failure{out->geterror()};
  if (exr) writeExr(*out, layers, layerCount);
  else if (!out->write_image(typeFrom(layers[0].format), layers[0].data)) throw Failure{out->geterror()};
  if (!out->close()) throw Failure{out->geterror()};
  if (sink.bytes(sink.user, bytes.data(), bytes.size()) != 0) throw Failure{"out of memory"};
}

int decode(const void* file, size_t size, const char* name, const ObscuraLayerSink* sink, char* error,
           size_t errorSize) {
  return report(error, errorSize, [&] { decodeFile(file, size, name, *sink); });
}

int encode(const char* name, const ObscuraLayer* layers, size_t layerCount, const ObscuraPlacement* place,
           const ObscuraByteSink* sink, char* error, size_t errorSize) {
  return report(error, errorSize, [&] { encodeFile(name, layers, layerCount, *place, *sink); });
}

}  // namespace

extern "C" __attribute__((visibility("default"))) const ObscuraOpenImageIO* obscuraOpenImageIO(void) {
  static const ObscuraOpenImageIO module{kObscuraOpenImageIOVersion, decode, encode};
  return &module;
}
