#include "brdf_kernel.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "obscura/tests/brdf_kernel.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "obscura/post/brdf-inl.h"

HWY_BEFORE_NAMESPACE();
namespace obscura::post {
namespace HWY_NAMESPACE {

// Lanes of a vector, one after the other.
HWY_INLINE void scatter(const V3& v, glm::vec3* out) {
  const DF d;
  HWY_ALIGN float lanes[3][16];
  hn::Store(v.x, d, lanes[0]);
  hn::Store(v.y, d, lanes[1]);
  hn::Store(v.z, d, lanes[2]);
  for (size_t i = 0; i < hn::Lanes(d); ++i) out[i] = {lanes[0][i], lanes[1][i], lanes[2][i]};
}

template <Brdf kBrdf>
void reflectVector(const tests::Lit* lit, tests::Reflected* out) {
  const DF d;
  HWY_ALIGN float in[15][16];
  for (size_t i = 0; i < hn::Lanes(d); ++i) {
    const ref::Surface& s = lit[i].surface;
    const glm::vec3& l = lit[i].l;
    const float values[15] = {s.base.x, s.base.y, s.base.z, s.metallic, s.roughness, s.n.x, s.n.y, s.n.z, s.v.x, s.v.y, s.v.z, l.x, l.y, l.z, lit[i].nl};
    for (int k = 0; k < 15; ++k) in[k][i] = values[k];
  }
  const auto load = [&](int k) { return hn::Load(d, in[k]); };
  const Reflection<kBrdf> reflection({load(0), load(1), load(2)}, load(3), load(4), {load(5), load(6), load(7)}, {load(8), load(9), load(10)});
  glm::vec3 diffuse[16], specular[16], towards[16];
  scatter(reflection.diffuse, diffuse);
  scatter(reflection.specular, specular);
  scatter(reflection.towards({load(11), load(12), load(13)}, load(14)), towards);
  for (size_t i = 0; i < hn::Lanes(d); ++i) out[i] = {diffuse[i], specular[i], towards[i]};
}

void ReflectAll(Brdf brdf, std::vector<tests::Lit> lit, std::vector<tests::Reflected>& out) {
  const size_t lanes = hn::Lanes(DF()), count = lit.size();
  lit.resize((count + lanes - 1) / lanes * lanes, lit.back());
  out.resize(lit.size());
  for (size_t i = 0; i < lit.size(); i += lanes) {
    switch (brdf) {
      case Brdf::Lambert: reflectVector<Brdf::Lambert>(&lit[i], &out[i]); break;
      case Brdf::Gltf: reflectVector<Brdf::Gltf>(&lit[i], &out[i]); break;
      case Brdf::BlinnPhong: reflectVector<Brdf::BlinnPhong>(&lit[i], &out[i]); break;
      case Brdf::BlinnPhongThresholded: reflectVector<Brdf::BlinnPhongThresholded>(&lit[i], &out[i]); break;
    }
  }
  out.resize(count);
}

void AllDirections(const Projector& p, int y, std::vector<glm::vec3>& out) {
  const int lanes = int(hn::Lanes(DF()));
  out.resize(size_t(p.width + lanes));
  const ViewDirections directions(p);
  for (int x = 0; x < p.width; x += lanes) scatter(directions.at(x, y), &out[size_t(x)]);
  out.resize(size_t(p.width));
}

}  // namespace HWY_NAMESPACE
}  // namespace obscura::post
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include "obscura/raster/dispatch.h"

namespace obscura::post {

HWY_EXPORT(ReflectAll);
HWY_EXPORT(AllDirections);

}  // namespace obscura::post

namespace obscura::tests {

std::vector<Reflected> reflectAll(post::Brdf brdf, const std::vector<Lit>& lit, raster::Target target) {
  using namespace post;
  std::vector<Reflected> out;
  OBSCURA_DISPATCH(ReflectAll, target)(brdf, lit, out);
  return out;
}

std::vector<glm::vec3> viewDirections(const post::Projector& projector, int y, raster::Target target) {
  using namespace post;
  std::vector<glm::vec3> out;
  OBSCURA_DISPATCH(AllDirections, target)(projector, y, out);
  return out;
}

}  // namespace obscura::tests
#endif
