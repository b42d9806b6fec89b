// In:  a scene and what the user asked for.
// Out: the camera of the frame, and scene-sized defaults.
#pragma once

#include <optional>
#include <string>

#include "obscura/engine/result.h"
#include "obscura/engine/scene.h"

namespace obscura::engine {

struct CameraRequest {
  std::string name;  // of a camera or the node that holds it, or its index; empty: the first, else one that frames the bounds
  std::optional<glm::dvec3> eye, target, up;  // any of them given: a free perspective camera
  std::optional<double> yFovDegrees;          // (0, 180); also replaces that of a perspective camera of the file
  std::optional<glm::dmat4> view, projection; // both: a camera of its own, see raster::cameraFromMatrices
};

// Usage: no such camera (the message lists those there are), a camera without direction or extent, matrices that are none of
// a camera, or more than one kind of camera.
Result<raster::Camera> chooseCamera(const Scene& scene, const CameraRequest& request, int width, int height);

// Length of the bounds' diagonal; 1 if there is none. Default settings are fractions of it:
double sceneSize(const Scene& scene);
constexpr double kDefaultRadius = 0.04;           // R, of the scene's size
constexpr double kDefaultBias = 0.01;             // of R
constexpr double kDefaultFilterThreshold = 0.2;   // of R
constexpr double kDefaultSeparation = 0.1;        // of R
constexpr double kLayerSeparation = 1;            // of R, if the containment test reads the second layer

}  // namespace obscura::engine
