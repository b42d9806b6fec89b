#include "obscura/post/display.h"

#include <cstring>
#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "obscura/post/display.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "obscura/post/vector-inl.h"

HWY_BEFORE_NAMESPACE();
namespace obscura::post {
namespace HWY_NAMESPACE {

HWY_INLINE VI encode(VF v, const DisplayTable& table) {
  const DF d;
  const DI di;
  const VF one = hn::Set(d, 1.0f), least = hn::Set(d, 1.0f / 8192);
  v = hn::IfThenElse(hn::Gt(v, least), v, least);  // below 2^-13 every value is byte 0
  v = hn::IfThenElse(hn::Lt(v, one), v, one);
  const VI upper = hn::Sub(hn::ShiftRight<16>(hn::BitCast(di, v)), hn::Set(di, int32_t(DisplayTable::kFirst)));
  const VI byte = hn::GatherIndex(di, table.guess, upper);
  const VF next = hn::GatherIndex(d, table.threshold + 1, byte);
  return hn::Add(byte, hn::IfThenElseZero(hn::RebindMask(di, hn::Ge(v, next)), hn::Set(di, 1)));
}

void Display(const LinearColor& in, const DisplayTable& table, int y0, int y1, DisplayImage& out) {
  const DF d;
  const DI di;
  for (int y = y0; y < y1; ++y)
    for (int x = 0; x < out.rgba.width(); x += int(hn::Lanes(d))) {
      const VI r = encode(hn::LoadU(d, in.rgb[0].row(y) + x), table), g = encode(hn::LoadU(d, in.rgb[1].row(y) + x), table);
      const VI b = encode(hn::LoadU(d, in.rgb[2].row(y) + x), table);
      const VI gb = hn::Or(hn::ShiftLeft<8>(g), hn::ShiftLeft<16>(b));
      const VI rgba = hn::Or(hn::Or(r, gb), hn::Set(di, int32_t(0xFF000000)));
      hn::StoreU(rgba, di, reinterpret_cast<int32_t*>(out.rgba.row(y)) + x);
    }
}

}  // namespace HWY_NAMESPACE
}  // namespace obscura::post
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include "obscura/raster/dispatch.h"
#include "obscura/raster/float_environment.h"
#include "obscura/raster/srgb.h"

namespace obscura::post {

HWY_EXPORT(Display);

DisplayTable::DisplayTable() {
  const raster::FloatEnvironment environment;
  threshold[0] = 0;
  for (int k = 1; k < 256; ++k) threshold[k] = float(raster::linearFromSrgb((k - 0.5) / 255));
  threshold[256] = std::numeric_limits<float>::infinity();
  int32_t byte = 0;
  for (uint32_t upper = kFirst; upper <= kLast; ++upper) {
    const uint32_t bits = upper << 16;
    float smallest;
    std::memcpy(&smallest, &bits, 4);
    while (smallest >= threshold[byte + 1]) ++byte;
    guess[upper - kFirst] = byte;
  }
}

void display(const LinearColor& in, const DisplayTable& table, int y0, int y1, DisplayImage& out, raster::Target target) {
  const raster::FloatEnvironment environment;
  OBSCURA_DISPATCH(Display, target)(in, table, y0, y1, out);
}

DisplayImage makeDisplayImage(int width, int height, DisplayImage used) {
  used.rgba.resize(width, height);
  return used;
}

}  // namespace obscura::post
#endif
