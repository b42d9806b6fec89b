// In: nothing; makes its own geometry.  Out: how far depth, normals and interpolated attributes are from the truth.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace obscura::apps {

// Errors over all covered pixels of a workload, of one quantity.
struct AccuracyRow {
  std::string workload;   // "plain", "slivers", ...
  std::string quantity;   // see measureAccuracy
  std::string unit;       // of max and rms: "scene units", "radians", "albedo"
  uint64_t pixels = 0;
  // Float ulps of the true value; of 1 where the value is a weight, a colour or a normal.
  double maxUlp = 0, rmsUlp = 0;
  double max = 0, rms = 0;
};

// Against evaluation in long double from the camera, the matrices and the vertices as they are given:
//   depth      zView against the plane through the snapped vertices, as snapping defines it (uncut triangles only)
//   surface    zView against the triangle itself, so with what snapping to 1/256 pixel costs
//   weights    barycentric weights, seen as albedo of vertex colours; max and rms: how far the point seen is displaced
//   texture    albedo of a linear ramp over u and v, seen through bilinear filtering
//   normal     interpolated and normalised; ulps: the worst component, max and rms: the angle
// `scale` >= 1 multiplies the triangles of each workload. Rendered with the best target; targets agree bit for bit.
std::vector<AccuracyRow> measureAccuracy(int scale = 1);

}  // namespace obscura::apps
