// In: planes of a frame.  Out: images, to be written, hashed or looked at.
#pragma once

#include <cstdint>
#include <initializer_list>

#include "obscura/engine/image.h"
#include "obscura/raster/plane.h"

namespace obscura::engine {

// All functions take planes of one size (where they are not, the image is empty: 0 x 0) and throw std::bad_alloc when
// there is no memory. Padding of the planes' rows is never read.

// Pixel by pixel, one channel per plane, in the order given: 1 to 4 planes, F32 or U32, every bit kept.
Image interleave(std::initializer_list<const raster::Plane<float>*> planes);
Image interleave(std::initializer_list<const raster::Plane<uint32_t>*> planes);

// False colours, U8 RGB: each id has a bright colour of its own, scattered by a hash so that neighbouring ids differ;
// 0xFFFFFFFF (nothing) is black. An id has the same colour in every image.
Image idPicture(const raster::Plane<uint32_t>& ids);

// Depth as grey, U8 RGB. With t from 0 at the nearest to 1 at the farthest finite depth of the plane:
// 32 + 223 (1 - sqrt(t)), so that the near part, where most of a picture lies, has most of the range.
// Infinity and NaN are black; if all finite depths are equal they are 255.
Image depthPicture(const raster::Plane<float>& zView);

// Unit vectors as U8 RGB: 255 (0.5 n + 0.5), rounded and clamped; NaN is 0.
Image normalPicture(const raster::Plane<float>& x, const raster::Plane<float>& y, const raster::Plane<float>& z);

}  // namespace obscura::engine
