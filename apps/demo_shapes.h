// The things the demo scene is made of, as meshes around the origin, y up, metres.
#pragma once

#include "obscura/apps/glb_writer.h"

namespace obscura::apps {

// Normals from the triangles around each vertex, weighted by area.
void setSmoothNormals(GlbMesh& mesh);

double groundHeight(double x, double z);  // of the ground mesh, exact at its vertices and within centimetres elsewhere
GlbMesh makeGround();                     // a rolling disc of 18 m radius, hilly at the rim, about 24,600 triangles

// A boulder of radius about 1: an icosphere of 20 * 4^subdivisions triangles, dented by noise and cut by planes.
GlbMesh makeStone(int subdivisions, uint64_t seed);

GlbMesh makeLeafClump(int leaves, uint64_t seed);  // folded leaves around a twig, 4 triangles each, radius about 0.4
GlbMesh makeGrassTuft(int blades, uint64_t seed);  // 3 triangles a blade, 0.3 high

GlbTexture makeLeafTexture();  // one leaf, its stalk at the lower edge (v = 1); alpha is its outline
GlbTexture makeBarkTexture();  // furrows along v; repeats seamlessly
GlbTexture makeSoilTexture();  // bright, fine-grained; repeats seamlessly

}  // namespace obscura::apps
