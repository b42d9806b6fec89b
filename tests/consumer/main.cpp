// A cube, lit by the ambient transfer function, as a PPM on standard output.
#include <cstdio>
#include <vector>

#include <obscura/post/display.h>
#include <obscura/post/transfer_samples.h>
#include <obscura/raster/rasterizer.h>

int main() {
  using namespace obscura;
  std::vector<glm::vec3> positions;
  for (int i = 0; i < 8; ++i) positions.push_back({i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1});
  const std::vector<uint32_t> indices = {0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6, 0, 1, 5, 0, 5, 4,
                                         2, 6, 7, 2, 7, 3, 0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5};
  raster::MeshView cube;
  cube.positions = positions;
  cube.indices = indices;
  const raster::Material material;
  const std::vector<raster::Instance> instances = {{&cube, 0, glm::dmat4(1)}};

  const int width = 320, height = 240;
  raster::Camera camera = raster::perspective(0.8, double(width) / height, 0.1);
  camera.viewFromWorld = raster::lookAt({3, 2, 4}, {0, 0, 0}, {0, 1, 0});
  raster::PlaneSet planes;
  planes.depth = planes.normal = planes.albedo = true;
  raster::GBuffer g;
  raster::Rasterizer().render({instances, {&material, 1}, {}}, camera, width, height, planes, g);

  const raster::Target target = raster::chooseTarget(raster::Target::Auto);
  post::AmbientSettings settings;
  const post::TransferInput in{&g, post::makeProjector(camera, width, height), settings, post::transferSamples(settings)};
  post::TransferSums sums = post::makeTransferSums(in);
  post::ambientTransfer(in, 0, height, sums, target);
  post::Transfer transfer = post::makeTransfer(width, height, false, true);
  post::depthFilter(in, sums, 0, height, transfer, target);
  post::LinearColor color = post::makeLinearColor(width, height);
  post::light({&g, &transfer, post::Occlusion::Transfer, glm::vec3(1), glm::vec3(0)}, 0, height, color, target);
  post::DisplayImage image = post::makeDisplayImage(width, height);
  post::display(color, post::DisplayTable(), 0, height, image, target);

  std::printf("P6 %d %d 255\n", width, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) std::fwrite(&image.rgba.at(x, y), 1, 3, stdout);
}
