// obscura-make-brdf-tables > post/brdf_table.cpp : writes the tables of brdf.h as C++.
#include <cstdio>

#include "obscura/post/make_brdf_table.h"

int main() {
  using namespace obscura::post;
  std::puts(R"(// Made by obscura-make-brdf-tables: change post/make_brdf_table.cpp and run it again, not this file.
#include "obscura/post/brdf.h"

namespace obscura::post {

// Gltf, BlinnPhong, BlinnPhongThresholded.
const uint32_t kBrdfTables[3][kBrdfTable * kBrdfTable] = {)");
  constexpr Brdf kGlossy[] = {Brdf::Gltf, Brdf::BlinnPhong, Brdf::BlinnPhongThresholded};
  for (const Brdf brdf : kGlossy) {
    std::puts("    {");
    for (int k = 0; k < kBrdfTable * kBrdfTable; ++k)
      std::printf("%s0x%08X,%s", k % 9 == 0 ? "        " : " ", unsigned(makeBrdfElement(brdf, k % kBrdfTable, k / kBrdfTable)), k % 9 == 8 || k + 1 == kBrdfTable * kBrdfTable ? "\n" : "");
    std::puts("    },");
  }
  std::puts("};\n\n}  // namespace obscura::post");
  return std::fflush(stdout) == 0 && std::ferror(stdout) == 0 ? 0 : 4;
}
