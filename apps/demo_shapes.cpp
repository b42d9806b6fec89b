#include "obscura/apps/demo_shapes.h"

#include <algorithm>
#include <map>
#include <utility>

#include "obscura/apps/demo_random.h"
#include "obscura/raster/exact_math.h"

namespace obscura::apps {
namespace {

using glm::dvec3;
using raster::exactCos;
using raster::exactSin;

constexpr double kTau = 6.283185307179586;
constexpr double kGroundRadius = 18;

uint8_t srgbByte(double linear) {  // sRGB transfer function, 0 ... 1 to 0 ... 255
  const double c = clamp01(linear);
  return uint8_t((c <= 0.0031308 ? 12.92 * c : 1.055 * raster::exactPow(c, 1 / 2.4) - 0.055) * 255 + 0.5);
}

void addTriangle(GlbMesh& mesh, uint32_t a, uint32_t b, uint32_t c) {
  mesh.indices.insert(mesh.indices.end(), {a, b, c});
}

uint32_t addVertex(GlbMesh& mesh, dvec3 position, dvec3 normal) {
  mesh.positions.emplace_back(position);
  mesh.normals.emplace_back(normal);
  return uint32_t(mesh.positions.size() - 1);
}

// A texture whose opposite edges meet. color: linear, of a point on a torus that u winds about the long way (a circle
// of radius 1 in x and y) and v the short way (a circle of radius `tube`).
template <class Color>
GlbTexture makeTiled(const char* name, double tube, Color color) {
  constexpr int kSize = 64;
  GlbTexture texture{name, kSize, kSize, {}};
  for (int y = 0; y < kSize; ++y)
    for (int x = 0; x < kSize; ++x) {
      const double u = kTau * x / kSize, v = kTau * y / kSize, r = 1 + tube * exactCos(v);
      const dvec3 c = color(dvec3(r * exactCos(u), r * exactSin(u), tube * exactSin(v)));
      texture.rgba.insert(texture.rgba.end(), {srgbByte(c.x), srgbByte(c.y), srgbByte(c.z), uint8_t{255}});
    }
  return texture;
}

}  // namespace

void setSmoothNormals(GlbMesh& mesh) {
  std::vector<dvec3> sums(mesh.positions.size(), dvec3(0));
  for (size_t i = 0; i < mesh.indices.size(); i += 3) {
    const uint32_t* v = &mesh.indices[i];
    const dvec3 p = mesh.positions[v[0]];
    const dvec3 n = cross(dvec3(mesh.positions[v[1]]) - p, dvec3(mesh.positions[v[2]]) - p);
    for (int k = 0; k < 3; ++k) sums[v[k]] += n;
  }
  mesh.normals.clear();
  for (const dvec3& n : sums) mesh.normals.emplace_back(unit(n));
}

double groundHeight(double x, double z) {
  const double r = std::sqrt(x * x + z * z);
  const double rolling = 0.55 * fractalNoise({x * 0.16, 0, z * 0.16}, 3, 11);
  const double bumps = 0.035 * fractalNoise({x * 1.1, 0, z * 1.1}, 2, 21);
  const double hills = smoothstep(9, kGroundRadius, r) * (1.0 + 1.1 * noise({x * 0.11, 0, z * 0.11}, 31));
  const double mound = 0.45 * (1 - smoothstep(0.2, 3.2, r));  // the roots lift the ground
  return rolling + bumps + hills + mound;
}

GlbMesh makeGround() {
  constexpr int kSectors = 160, kRings = 77;
  const dvec3 grass{0.20, 0.29, 0.085}, dry{0.40, 0.36, 0.16}, earth{0.31, 0.215, 0.14};
  GlbMesh mesh;
  mesh.name = "ground";
  const auto add = [&](double x, double z) {
    mesh.positions.emplace_back(dvec3(x, groundHeight(x, z), z));
    mesh.uvs.emplace_back(float(x / 1.5), float(z / 1.5));
    const double patch = fractalNoise({x * 0.45, 0, z * 0.45}, 4, 41);
    const double path = fractalNoise({x * 0.2, 5, z * 0.2}, 3, 51);
    const double trodden = 1 - smoothstep(0.6, 3.4, std::sqrt(x * x + z * z) + 1.3 * patch);
    dvec3 color = mix(grass, dry, smoothstep(-0.3, 0.9, patch));
    color = mix(color, earth, std::max(0.85 * trodden, smoothstep(0.25, 0.7, path)));
    mesh.colors.emplace_back(color * (1.25 + 0.2 * noise({x * 3, 0, z * 3}, 61)));
  };
  add(0, 0);
  double radius = 0.25;
  for (int ring = 0; ring < kRings; ++ring) {  // ever wider rings: cells stay about square
    for (int s = 0; s < kSectors; ++s) {
      const double angle = kTau * (s + 0.5 * (ring & 1)) / kSectors;
      add(radius * exactCos(angle), radius * exactSin(angle));
    }
    radius = std::min(radius * 1.0578, kGroundRadius);
  }
  for (uint32_t s = 0; s < kSectors; ++s) {
    const uint32_t next = (s + 1) % kSectors;
    addTriangle(mesh, 0, 1 + next, 1 + s);
    for (uint32_t ring = 0; ring + 1 < kRings; ++ring) {
      const uint32_t inner = 1 + ring * kSectors, outer = inner + kSectors;
      // Odd rings are turned by half a sector: the vertex opposite to the inner edge alternates.
      if (ring & 1) {
        addTriangle(mesh, inner + s, inner + next, outer + next);
        addTriangle(mesh, inner + s, outer + next, outer + s);
      } else {
        addTriangle(mesh, inner + s, inner + next, outer + s);
        addTriangle(mesh, inner + next, outer + next, outer + s);
      }
    }
  }
  setSmoothNormals(mesh);
  return mesh;
}

GlbMesh makeStone(int subdivisions, uint64_t seed) {
  const double g = 1.618033988749895;  // golden ratio: the corners of an icosahedron
  std::vector<dvec3> corners;
  for (int i = 0; i < 4; ++i) {
    const double a = i & 1 ? 1 : -1, b = i & 2 ? g : -g;
    corners.insert(corners.end(), {unit({a, b, 0}), unit({0, a, b}), unit({b, 0, a})});
  }
  std::vector<uint32_t> triangles;
  for (uint32_t a = 0; a < 12; ++a)
    for (uint32_t b = a + 1; b < 12; ++b)
      for (uint32_t c = b + 1; c < 12; ++c) {
        if (dot(corners[a], corners[b]) < 0.4 || dot(corners[b], corners[c]) < 0.4 || dot(corners[c], corners[a]) < 0.4)
          continue;  // neighbours have 1 / sqrt 5
        const bool outwards = dot(cross(corners[b] - corners[a], corners[c] - corners[a]), corners[a]) > 0;
        triangles.insert(triangles.end(), {a, outwards ? b : c, outwards ? c : b});
      }
  for (int level = 0; level < subdivisions; ++level) {
    std::map<std::pair<uint32_t, uint32_t>, uint32_t> middles;
    const auto middle = [&](uint32_t a, uint32_t b) {
      const auto [found, isNew] = middles.try_emplace({std::min(a, b), std::max(a, b)}, uint32_t(corners.size()));
      if (isNew) corners.push_back(unit(corners[a] + corners[b]));
      return found->second;
    };
    std::vector<uint32_t> finer;
    for (size_t i = 0; i < triangles.size(); i += 3) {
      const uint32_t a = triangles[i], b = triangles[i + 1], c = triangles[i + 2];
      const uint32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
      finer.insert(finer.end(), {a, ab, ca, ab, b, bc, ca, bc, c, ab, bc, ca});
    }
    triangles = std::move(finer);
  }
  struct Cut {
    dvec3 normal;
    double distance;
  };
  Random random(seed);
  std::vector<Cut> cuts;
  for (int i = 0; i < 9; ++i) {
    const dvec3 normal = random.direction();
    cuts.push_back({normal, random.in(0.62, 0.9)});
  }
  GlbMesh mesh;
  mesh.name = "stone";
  for (const dvec3& direction : corners) {
    dvec3 p = direction * (1 + 0.16 * fractalNoise(direction * 1.3, 3, seed));
    for (const Cut& cut : cuts) {  // not quite flat, with a rounded edge
      const double over = dot(p, cut.normal) - cut.distance;
      if (over > 0) p -= cut.normal * (0.9 * over * smoothstep(0, 0.12, over));
    }
    p += direction * (0.03 * fractalNoise(direction * 5.0, 3, seed + 7));
    mesh.positions.emplace_back(p);
    const double lichen = smoothstep(0.2, 0.75, fractalNoise(direction * 2.6, 4, seed + 17));
    const double grain = 1 + 0.2 * noise(direction * 9.0, seed + 27);
    mesh.colors.emplace_back(mix(dvec3(0.82), dvec3(0.80, 0.84, 0.58), lichen) * grain);
  }
  mesh.indices = std::move(triangles);
  setSmoothNormals(mesh);
  return mesh;
}

GlbMesh makeLeafClump(int leaves, uint64_t seed) {
  GlbMesh mesh;
  mesh.name = "leaves";
  Random random(seed);
  for (int i = 0; i < leaves; ++i) {
    const dvec3 outwards = unit(random.direction() + dvec3(0, 0.25, 0));
    const dvec3 base = outwards * random.in(0.05, 0.3);
    const dvec3 along = unit(outwards + 0.7 * random.direction() - dvec3(0, 0.25, 0));  // leaves hang a little
    const dvec3 side = unit(cross(along, random.direction() + dvec3(0, 0.6, 0)));
    dvec3 face = cross(side, along);
    if (dot(face, outwards) < 0) face = -face;
    const double length = random.in(0.17, 0.26), half = 0.4 * length;
    const dvec3 tip = base + along * length, fold = face * (0.3 * half);
    const dvec3 bend = face * (-0.12 * length);  // the tip curls away
    const double shade = random.in(0.78, 1.12);
    // Left edge, midrib, right edge, at the stalk and at the tip; each half of the leaf leans inwards.
    const dvec3 lit = face + 0.35 * outwards;  // bent towards the outside of the clump
    const dvec3 leftNormal = unit(lit + 0.3 * side), rightNormal = unit(lit - 0.3 * side), middleNormal = unit(lit);
    const uint32_t first = addVertex(mesh, base - side * half + fold, leftNormal);
    addVertex(mesh, base, middleNormal);
    addVertex(mesh, base + side * half + fold, rightNormal);
    addVertex(mesh, tip - side * half + fold + bend, leftNormal);
    addVertex(mesh, tip + bend, middleNormal);
    addVertex(mesh, tip + side * half + fold + bend, rightNormal);
    for (float v : {1.0f, 0.0f})
      for (float u : {0.0f, 0.5f, 1.0f}) mesh.uvs.emplace_back(u, v);
    mesh.colors.insert(mesh.colors.end(), 6, glm::vec3(dvec3(shade)));
    const bool flipped = dot(cross(side, along), face) < 0;  // counter-clockwise seen from `face`
    for (uint32_t column = first; column < first + 2; ++column) {
      addTriangle(mesh, column, flipped ? column + 4 : column + 1, flipped ? column + 1 : column + 4);
      addTriangle(mesh, column, flipped ? column + 3 : column + 4, flipped ? column + 4 : column + 3);
    }
  }
  return mesh;
}

GlbMesh makeGrassTuft(int blades, uint64_t seed) {
  GlbMesh mesh;
  mesh.name = "grass";
  Random random(seed);
  for (int i = 0; i < blades; ++i) {
    const double yaw = random.in(0, kTau), lean = random.in(0.1, 0.75), height = random.in(0.14, 0.3);
    const dvec3 outwards{exactCos(yaw), 0, exactSin(yaw)}, side = cross({0, 1, 0}, outwards);
    const dvec3 root = outwards * random.in(0.0, 0.07), half = side * random.in(0.006, 0.012);
    const dvec3 knee = root + dvec3(0, 0.6 * height, 0) + outwards * (0.3 * lean * height);
    const dvec3 tip = root + dvec3(0, height, 0) + outwards * (lean * height);
    const dvec3 normal = unit(dvec3(0, 1, 0) - 0.5 * outwards);  // mostly upwards: tufts blend into the ground
    const uint32_t first = addVertex(mesh, root - half, normal);
    for (const dvec3& p : {root + half, knee - half, knee + half, tip}) addVertex(mesh, p, normal);
    addTriangle(mesh, first, first + 3, first + 1);
    addTriangle(mesh, first, first + 2, first + 3);
    addTriangle(mesh, first + 2, first + 4, first + 3);
    const dvec3 color = mix(dvec3(0.75), dvec3(1.25, 1.1, 0.9), random.in(0, 1));
    for (double bright : {0.55, 0.55, 0.9, 0.9, 1.1}) mesh.colors.emplace_back(0.75 * bright * color);
  }
  return mesh;
}

GlbTexture makeLeafTexture() {
  constexpr int kSize = 64;
  GlbTexture texture{"leaf", kSize, kSize, {}};
  for (int y = 0; y < kSize; ++y)
    for (int x = 0; x < kSize; ++x) {
      const double across = std::fabs((x + 0.5) / kSize - 0.5) * 2;  // 0 at the midrib, 1 at the edge of the image
      const double up = 1 - (y + 0.5) / kSize;                        // 0 at the stalk, 1 at the tip
      const double t = clamp01((up - 0.08) / 0.9);
      const double outline = up < 0.1 ? 0.05 : 3.1 * t * (1 - t) * (1.2 - 0.5 * t) + 0.04 * (1 - t);
      const bool midrib = across < 0.05;
      const double wave = (up + 0.35 * across) * 7, phase = wave - std::floor(wave);
      const double vein = phase < 0.14 ? 0.25 : 0.0, speckle = 0.12 * noise({x * 0.3, y * 0.3, 0}, 71);
      const double bright = 0.8 + speckle + (midrib ? 0.3 : vein) + 0.1 * across;
      texture.rgba.insert(texture.rgba.end(), {srgbByte(0.85 * bright), srgbByte(0.9 * bright), srgbByte(0.8 * bright),
                                               uint8_t(across < outline ? 255 : 0)});
    }
  return texture;
}

GlbTexture makeBarkTexture() {
  return makeTiled("bark", 0.14, [](dvec3 p) {
    const double ridge = 1 - std::fabs(fractalNoise(p * 2.6, 3, 81)), grain = noise(p * 9.0, 91);
    const double bright = clamp01(0.3 + 0.6 * ridge * ridge + 0.1 * grain);
    return dvec3(1, 0.97, 0.93) * bright;
  });
}

GlbTexture makeSoilTexture() {
  return makeTiled("soil", 0.5, [](dvec3 p) {
    const double clods = fractalNoise(p * 2.2, 3, 111), grit = noise(p * 9.0, 121);
    return dvec3(0.97, 1, 0.95) * clamp01(0.74 + 0.22 * clods + 0.16 * grit);
  });
}

}  // namespace obscura::apps
