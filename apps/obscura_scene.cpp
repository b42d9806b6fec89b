// obscura-scene: makes scenes of the project's own as .glb files.
#include <cstdio>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "obscura/apps/demo_lights.h"
#include "obscura/apps/demo_scene.h"
#include "obscura/apps/demo_surfaces.h"
#include "obscura/engine/image_file.h"

int main(int argc, char** argv) {
  using namespace obscura;
  CLI::App app{"Makes scenes of the project's own, the same bytes on every machine.", "obscura-scene"};
  app.require_subcommand(1);
  std::string output;
  const struct {
    const char *name, *what;
    apps::GlbScene (*make)();
  } kScenes[] = {{"demo", "a tree with stones on uneven ground, some 120,000 triangles", apps::makeDemoScene},
                 {"implicit", "implicit surfaces of each kind on a floor of triangles", apps::makeImplicitScene},
                 {"relief", "a floor that a height map displaces", apps::makeReliefScene},
                 {"lights", "a courtyard at dusk: a low sun, a lamp and a spot, which cast shadows", apps::makeLightsScene},
                 {"materials", "spheres from smooth to rough, of metal and of other things, on tiles", apps::makeMaterialsScene}};
  for (const auto& scene : kScenes)
    app.add_subcommand(scene.name, scene.what)->add_option("-o,--output", output, "the .glb file to write; - is standard output")->required();
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& e) {
    return app.exit(e) == 0 ? 0 : 2;
  }
  std::vector<uint8_t> bytes;
  for (const auto& scene : kScenes)
    if (app.got_subcommand(scene.name)) bytes = apps::glbFromScene(scene.make());
  const engine::Result<engine::Done> written = engine::writeFileAtomically(output, {bytes.data(), bytes.size()});
  if (written) return 0;
  std::fprintf(stderr, "obscura-scene: %s\n", written.error().text().c_str());
  return 4;
}
