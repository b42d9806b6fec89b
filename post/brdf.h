// How surfaces reflect, and how much of the light that comes from everywhere: f(l, v) and R_A(v) (Akenine-Moller, Haines,
// Hoffman, "Real-Time Rendering", 3rd edition, equation 8.21: the integral of f(l, v) cos over the hemisphere).
// SIMD in brdf-inl.h, its scalar twin in brdf_ref.h.
#pragma once

#include <cstdint>

namespace obscura::post {

// Of a base colour c, metallic m and roughness r of the G-buffer; n.v is the cosine between normal and view, F(F0) is
// Schlick's Fresnel term F0 + (1 - F0) (1 - v.h)^5. E, A and B are integrals over the hemisphere, so functions of n.v and r:
// E of the specular part for F = 1, B for F = (1 - v.h)^5, A = E - B. What is unlit (m is -0) reflects nothing.
//
// Lambert      f = c / pi, R_A = c. Reads no planes but the albedo.
// Gltf         the metallic-roughness material of glTF 2.0 (appendix B): D of GGX, alpha = r^2, and the height-correlated
//              visibility V of Smith. One bounce between microfacets loses light; Turquin's k(F0) = 1 + F0 (1 - E) / E gives
//              it back ("Practical multiple scattering compensation for microfacet models"). S(F0) = (F0 A + B) k(F0) and
//                f = D V [m F(c) k(c) + (1 - m) F(0.04) k(0.04)] + (1 - m) c (1 - S(0.04)) / pi
//                R_A = m S(c) + (1 - m) (S(0.04) + c (1 - S(0.04)))
//              White (c = 1) has R_A = 1 whatever m, r and v are, and nothing has more.
// BlinnPhong   f = F(c_spec) N (n.h)^p + c_diff / pi, with c_spec from 0.04 to c by m, c_diff = (1 - m) c (1 - S(c_spec)),
//              S(F0) = F0 A + B, R_A = S(c_spec) + c_diff. The shininess p = 2 / alpha^2 - 2 is kept in 1 ... 8192; powers
//              of p, here and below, are linear between those of whole numbers. N makes E(n.v = 1) = 1, so that energy is
//              not gained: (p + 2) (p + 4) / (8 pi (p + 2^(-p/2))), which RTR rounds to (p + 8) / (8 pi). White has R_A = 1
//              if m = 0; metals darken towards their outline, as nothing is divided by cosines there.
// BlinnPhongThresholded  the same with 3/4 in place of (n.h)^p where that is at least 1/2, and 0 elsewhere: the sharp
//              highlight of RTR's figure 8.7. With 1 in place of 3/4 the broadest highlights would gain energy.
enum class Brdf : uint8_t { Lambert, Gltf, BlinnPhong, BlinnPhongThresholded };

constexpr float kDielectric = 0.04f;        // F0 of what is no metal
constexpr float kLeastFacing = 1.0f / 1024; // |n.v| is taken to be at least this
constexpr float kLeastAlpha = 1.0f / 256;   // of GGX: nothing divides by 0, and highlights are bounded
constexpr float kMostShininess = 8192;
constexpr float kThresholded = 0.75f;       // of the highlight where it is seen

// Whether it reads metallic, roughness and the direction of view.
constexpr bool isGlossy(Brdf brdf) { return brdf != Brdf::Lambert; }

// E and B / E over (n.v, r), made offline (make_brdf_table.h): element [j kBrdfTable + i] is that of n.v = (i / 31)^2 and
// r = j / 31, E in the lower and B / E, which stays below 1, in the upper 16 bits, 2^15 being 1. Between them: bilinear in sqrt(n.v) and r.
// Errors against direct integration, by roughness: docs/lighting.md.
constexpr int kBrdfTable = 32;
extern const uint32_t kBrdfTables[3][kBrdfTable * kBrdfTable];
inline const uint32_t* brdfTable(Brdf glossy) { return kBrdfTables[int(glossy) - 1]; }

}  // namespace obscura::post
