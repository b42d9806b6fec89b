// Two cubes on a floor under an open sky, by the ambient transfer function; a PPM on standard output.
#include <cstdio>
#include <vector>
#include <obscura/post/display.h>
#include <obscura/post/transfer_samples.h>
#include <obscura/raster/rasterizer.h>

int main() {
  using namespace obscura;
  std::vector<glm::vec3> corners;
  for (int i = 0; i < 8; ++i) corners.push_back({i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1});
  const std::vector<uint32_t> faces = {0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6, 0, 1, 5, 0, 5, 4,
                                       2, 6, 7, 2, 7, 3, 0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5};
  raster::MeshView cube;
  cube.positions = corners, cube.indices = faces;
  std::vector<raster::Material> materials(3);  // red, blue, grey
  materials[0].baseColor = {0.6f, 0.1f, 0.06f, 1};
  materials[1].baseColor = {0.1f, 0.25f, 0.6f, 1};
  materials[2].baseColor = {0.4f, 0.4f, 0.4f, 1};
  glm::dmat4 small(0.5), wide(9);  // the same mesh again: half as large, and as a floor
  small[3] = {1.6, -0.5, 0.2, 1}, wide[1][1] = 1, wide[3] = {0, -2, 0, 1};
  const std::vector<raster::Instance> instances = {{&cube, 0, glm::dmat4(1)}, {&cube, 1, small}, {&cube, 2, wide}};

  const int width = 320, height = 240;
  raster::Camera camera = raster::perspective(0.7, double(width) / height, 0.1);
  camera.viewFromWorld = raster::lookAt({3, 3, 5}, {0.4, -0.4, 0}, {0, 1, 0});
  raster::PlaneSet planes;
  planes.depth = planes.normal = planes.albedo = true;
  raster::GBuffer g;
  raster::Rasterizer().render({instances, materials, {}}, camera, width, height, planes, g);

  post::AmbientSettings s;
  s.samples = 32, s.radius = 1.5f, s.bias = 0.03f, s.filterThreshold = 0.15f;  // lengths in scene units
  const raster::Target target = raster::chooseTarget(raster::Target::Auto);
  const post::TransferInput in{&g, post::makeProjector(camera, width, height), s, post::transferSamples(s)};
  post::TransferSums sums = post::makeTransferSums(in);
  post::ambientTransfer(in, 0, height, sums, target);
  post::Transfer w = post::makeTransfer(width, height, {false, true});
  post::depthFilter(in, sums, 0, height, w, target);
  post::LinearColor color = post::makeLinearColor(width, height);  // light from all around, and the sky behind
  post::light({&g, &w, post::Occlusion::Transfer, glm::vec3(1.5f), {0.3f, 0.5f, 0.9f}}, 0, height, color, target);
  post::DisplayImage image = post::makeDisplayImage(width, height);
  post::display(color, post::DisplayTable(), 0, height, image, target);

  std::printf("P6 %d %d 255\n", width, height);
  for (int i = 0; i < width * height; ++i) std::fwrite(&image.rgba.at(i % width, i / width), 1, 3, stdout);
}
