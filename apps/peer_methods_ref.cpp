// Scalar twins of peer_volumes.cpp and peer_horizons.cpp, after peer_methods.h.
#include <cmath>
#include <limits>

#include "obscura/apps/peer_methods.h"
#include "obscura/post/depth_map_ref.h"
#include "obscura/raster/float_environment.h"

namespace obscura::apps {
namespace {

float dot(const glm::vec3& a, const glm::vec3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

class Twin {
 public:
  Twin(const PeerSettings& peer, const post::TransferInput& in, int x, int y)
      : peer_(peer), in_(in), q_(in.projector), s_(in.settings), x_(pointOf(x, y)),
        n_(in.g->normal[0].at(x, y), in.g->normal[1].at(x, y), -in.g->normal[2].at(x, y)),
        points_(&in.offsets[size_t(((x + q_.xFirst) & 3) + 4 * ((y + q_.yFirst) & 3)) * size_t(s_.samples)]) {
    eye_ = q_.perspective ? x_ * (-1 / std::sqrt(dot(x_, x_))) : glm::vec3(0, 0, -1);
  }

  float open() const {
    switch (peer_.method) {
      case PeerMethod::Ssao: return ssao();
      case PeerMethod::Hbao: return hbao();
      case PeerMethod::Vao: return vao();
      case PeerMethod::Gtao: break;
    }
    return gtao();
  }

 private:
  // What the pixel (x, y) of the G-buffer shows.
  glm::vec3 pointOf(int x, int y) const {
    const float z = in_.g->depth.at(x, y), w = q_.perspective ? z : 1;
    return {(float(x + q_.xFirst) + 0.5f - q_.xCenter) * q_.xInverse * w, (float(y + q_.yFirst) + 0.5f - q_.yCenter) * q_.yInverse * w, z};
  }
  float depthAt(const glm::vec3& p) const {
    const post::Texel texel = post::project(q_, p);
    return in_.g->depth.at(texel.x, texel.y);
  }

  float ssao() const {
    float sum = 0;
    for (int i = 0; i < s_.samples; ++i) {
      const glm::vec3 p = x_ + points_[i];
      const float stored = depthAt(p);
      if (!(p.z > stored && p.z > q_.zNear)) sum += 2;
      else if (!(x_.z - stored < deepest())) sum += 1;
    }
    return sum;
  }

  float vao() const {
    const glm::vec3 center = x_ + 0.5f * s_.radius * n_;
    const glm::vec3 e = q_.perspective ? center * (1 / std::sqrt(dot(center, center))) : glm::vec3(0, 0, 1);
    const float k = 1 / (1 + e.z);
    const glm::vec3 b1(1 - e.x * e.x * k, -(e.x * e.y * k), -e.x), b2(-(e.x * e.y * k), 1 - e.y * e.y * k, -e.y);
    float whole = 0, inner = 0;
    for (int i = 0; i < s_.samples; ++i) {
      const glm::vec3 p = center + (points_[i].x * b1 + points_[i].y * b2);
      const float stored = depthAt(p), along = points_[i].z * e.z, last = stored + deepest();
      const float from = stored > p.z - along ? stored : p.z - along, to = last < p.z + along ? last : p.z + along;
      whole += (p.z + along) - (p.z - along);
      if (to > from) inner += to - from;
    }
    const float n = float(s_.samples);
    return whole > 0 ? n - n * (inner / whole) : n - n * 0.0f;
  }

  struct Slice {
    float normal, level, length;
  };
  Slice slice(const glm::vec2& direction) const {
    const float facing = dot(n_, eye_), tilt = direction.x * eye_.x + direction.y * eye_.y;
    float level = direction.x * n_.x + direction.y * n_.y;
    if (q_.perspective) level = (level - tilt * facing) / std::sqrt(1 - tilt * tilt);
    const float length = std::sqrt(facing * facing + level * level);
    return length > 0 ? Slice{facing / length, level / length, length} : Slice{1, 0, length};
  }

  // Cosine to V and square of the distance of what is seen at `far` R in a direction of the image.
  glm::vec2 look(const Slice& q, const glm::vec2& direction, float low, float far) const {
    const float r = s_.radius * far;
    const post::Texel texel = post::project(q_, {x_.x + direction.x * r, x_.y + direction.y * r, x_.z});
    const glm::vec3 to = pointOf(texel.x, texel.y) - x_;
    const float square = dot(to, to), height = dot(to, n_) / q.length, rest = square - height * height;
    return {(std::sqrt(rest > 0 ? rest : 0) * low + height * q.normal) / std::sqrt(square), square};
  }

  float partOfR(int j, float shift) const {
    const float even = (float(j) + shift) * (1 / float(peer_.steps));
    return even * even;
  }

  float hbao() const {
    float blocked = 0;
    const float whole = s_.radius * s_.radius;
    for (int i = 0; i < s_.samples; ++i) {
      const glm::vec2 direction(points_[i]);
      const Slice q = slice(direction);
      float highest = -q.level;
      for (int j = 0; j < peer_.steps; ++j) {
        const glm::vec2 seen = look(q, direction, -q.level, partOfR(j, points_[i].z));
        if (!(seen.x > highest && seen.y < whole)) continue;
        const float part = seen.y / whole;
        blocked += (1 - (peer_.aim == PeerAim::Own ? part : std::sqrt(part))) * (seen.x - highest);
        highest = seen.x;
      }
    }
    return float(s_.samples) - blocked;
  }

  float horizon(const Slice& q, const glm::vec2& direction, float low, float shift) const {
    const float from = peer_.aim == PeerAim::Own ? kGtaoFalloff : kGtaoFalloffToO, end = 1 / (1 - from), slope = end / s_.radius;
    float highest = low;
    for (int j = 0; j < peer_.steps; ++j) {
      const glm::vec2 seen = look(q, direction, low, partOfR(j, shift));
      const float weight = end - std::sqrt(seen.y) * slope, sunk = low + (weight < 1 ? weight : 1) * (seen.x - low);
      if (sunk > highest && seen.y < s_.radius * s_.radius) highest = sunk;
    }
    return highest < 1 ? highest : 1;
  }

  static float arcWithChord(float c) {
    const float x = 1 - std::fabs(c);
    const float of = x * std::sqrt(x) * (((-0.0112203658f * x - 0.0182239134f) * x - 0.285760701f) * x + 1.88600671f);
    return c < 0 ? 3.14159274f - of : of;
  }

  float gtao() const {
    float sum = 0;
    for (int i = 0; i < s_.samples; ++i) {
      const glm::vec2 direction(points_[i]);
      const Slice q = slice(direction);
      const float up = horizon(q, direction, -q.level, points_[i].z), down = horizon(q, -direction, q.level, points_[i].z);
      sum += 0.5f * q.length * (q.normal * (2 - (up * up + down * down)) + q.level * (arcWithChord(up) - arcWithChord(down)));
    }
    return sum;
  }

  float deepest() const { return s_.silhouetteBound ? s_.radius : std::numeric_limits<float>::infinity(); }

  const PeerSettings& peer_;
  const post::TransferInput& in_;
  const post::Projector& q_;
  const post::AmbientSettings& s_;
  glm::vec3 x_, n_, eye_;
  const glm::vec3* points_;
};

}  // namespace

void peerOcclusionRef(const PeerSettings& peer, const post::TransferInput& in, int y0, int y1, post::TransferSums& out) {
  const raster::FloatEnvironment environment;
  const float n = float(in.settings.samples);
  for (int y = y0; y < y1; ++y)
    for (int x = 0; x < in.g->width; ++x) {
      const bool seen = in.g->depth.at(x, y) < std::numeric_limits<float>::infinity();
      float value = seen ? Twin(peer, in, x, y).open() : n;
      if (!(value == value)) value = 0;
      out.numerator.at(x, y) = value;
      uint8_t& open = out.open.at(x / post::kSegment, y);
      open = (x % post::kSegment == 0 || open) && value == n;
    }
}

}  // namespace obscura::apps
