#include "obscura/apps/gl_frame.h"

#include <algorithm>
#include <stdexcept>

#include <glm/matrix.hpp>

#include "obscura/post/projector.h"
#include "obscura/post/sample_sets.h"
#include "obscura/post/transfer_samples.h"
#include "obscura/raster/stopwatch.h"

namespace obscura::apps {
namespace {

// OpenGL's numbers.
enum : unsigned {
  kTexture2D = 0x0DE1, kRgba = 0x1908, kFloat = 0x1406, kByte = 0x1401, kUint = 0x1405, kRgba32F = 0x8814, kRgba16F = 0x881A,
  kRgba8 = 0x8058, kSrgb8Alpha8 = 0x8C43, kDepth32F = 0x8CAC, kDepthComponent = 0x1902, kNearest = 0x2600, kLinear = 0x2601,
  kMinFilter = 0x2801, kMagFilter = 0x2800, kWrapS = 0x2802, kWrapT = 0x2803, kMaxLevel = 0x813D, kRepeat = 0x2901,
  kClampToEdge = 0x812F, kMirroredRepeat = 0x8370, kTexture0 = 0x84C0, kFramebuffer = 0x8D40, kColor0 = 0x8CE0,
  kDepthAttachment = 0x8D00, kComplete = 0x8CD5, kArrayBuffer = 0x8892, kElementBuffer = 0x8893, kStaticDraw = 0x88E4,
  kVertexShader = 0x8B31, kFragmentShader = 0x8B30, kLinked = 0x8B82, kDepthTest = 0x0B71, kCullFace = 0x0B44, kClockwise = 0x0900,
  kCounterClockwise = 0x0901, kColorAndDepth = 0x4100, kTriangles = 4, kRenderer = 0x1F01
};

// Images have their first row at the top, as obscura's have: y is turned over, and with it the triangles' sense.
constexpr char kGeometryVertex[] = R"(#version 330
layout(location = 0) in vec3 position; layout(location = 1) in vec3 normal;
layout(location = 2) in vec2 uv; layout(location = 3) in vec4 color;
uniform mat4 viewFromObject; uniform mat3 viewFromNormal; uniform vec4 projection; uniform vec2 depth;
out vec3 viewPosition, viewNormal; out vec2 texel; out vec4 tint;
void main() {
  vec4 v = viewFromObject * vec4(position, 1);
  float w = -v.z;
  gl_Position = vec4(projection.x * v.x + projection.z * w, -(projection.y * v.y + projection.w * w), depth.x * w + depth.y, w);
  viewPosition = v.xyz; viewNormal = viewFromNormal * normal; texel = uv; tint = color;
})";
constexpr char kGeometryFragment[] = R"(#version 330
in vec3 viewPosition, viewNormal; in vec2 texel; in vec4 tint;
uniform sampler2D image; uniform vec4 baseColor; uniform vec3 uvRows[2]; uniform float cutoff; uniform int textured;
layout(location = 0) out vec4 surface; layout(location = 1) out vec4 albedo;
void main() {
  vec4 color = baseColor * tint;
  if (textured != 0) color *= texture(image, vec2(dot(uvRows[0], vec3(texel, 1)), dot(uvRows[1], vec3(texel, 1))));
  if (color.a < cutoff) discard;
  vec3 n = viewNormal;
  if (dot(n, n) == 0.0) { n = cross(dFdx(viewPosition), dFdy(viewPosition)); if (dot(n, viewPosition) > 0.0) n = -n; }
  else if (!gl_FrontFacing) n = -n;
  surface = vec4(normalize(n), -viewPosition.z);
  albedo = vec4(color.rgb, 1);
})";
constexpr char kScreenVertex[] = R"(#version 330
void main() { vec2 p = vec2((gl_VertexID << 1) & 2, gl_VertexID & 2); gl_Position = vec4(p * 2.0 - 1.0, 0, 1); })";
// The shader of the long paper's section 5, in its symbols.
constexpr char kTransferFragment[] = R"(
uniform sampler2D surface, albedo; uniform vec4 toPixels; uniform float radius, bias, zNear;
uniform vec3 xyz[N]; uniform vec2 turns[16];
out vec4 sums;
void main() {
  ivec2 here = ivec2(gl_FragCoord.xy), last = textureSize(surface, 0) - 1;
  vec4 g = texelFetch(surface, here, 0);
  sums = vec4(N);
  if (g.w <= 0.0) return;
  vec3 x = vec3((gl_FragCoord.xy - toPixels.zw) / toPixels.xy * g.w, g.w), n = vec3(g.xy, -g.z);
  vec3 t = normalize(cross(n, vec3(0, 1, 0.01))), b = cross(n, t);
  vec2 r = turns[(here.x & 3) + 4 * (here.y & 3)];
  vec3 T = r.x * t + r.y * b, B = r.y * t - r.x * b;
  sums.a = 0.0;
  for (int i = 0; i < N; ++i) {
    vec3 p = x + xyz[i].x * T + xyz[i].y * B + xyz[i].z * n;
    ivec2 q = clamp(ivec2(floor(p.xy / p.z * toPixels.xy + toPixels.zw)), ivec2(0), last);
    float z = texelFetch(surface, q, 0).w, behind = p.z - z;
    if (z > 0.0 && behind > bias && behind < radius && p.z > zNear) sums.rgb -= texelFetch(albedo, q, 0).rgb;
    else sums.a += 1.0;
  }
})";
constexpr char kFilterFragment[] = R"(#version 330
uniform sampler2D surface, albedo, transfer; uniform float threshold;
out vec4 picture;
void main() {
  ivec2 here = ivec2(gl_FragCoord.xy), last = textureSize(surface, 0) - 1;
  float z = texelFetch(surface, here, 0).w;
  vec4 sum = vec4(0);
  for (int j = -2; j < 2; ++j) for (int i = -2; i < 2; ++i) {
    ivec2 q = clamp(here + ivec2(i, j), ivec2(0), last);
    if (abs(texelFetch(surface, q, 0).w - z) < threshold) sum += texelFetch(transfer, q, 0);
  }
  vec3 w = mix(vec3(1), sum.a / max(sum.rgb, vec3(1e-6)), greaterThan(sum.rgb, vec3(sum.a)));
  picture = vec4(texelFetch(albedo, here, 0).rgb * w, 1);
})";

unsigned wrapOf(raster::Wrap wrap) {
  return wrap == raster::Wrap::Repeat ? kRepeat : wrap == raster::Wrap::MirroredRepeat ? kMirroredRepeat : kClampToEdge;
}

unsigned minFilterOf(const raster::TextureView& t) {
  const unsigned filter = t.minFilter == raster::Filter::Linear ? 1 : 0;
  if (t.mip == raster::MipFilter::None) return kNearest + filter;
  return 0x2700 + filter + (t.mip == raster::MipFilter::Linear ? 2 : 0);  // GL_NEAREST_MIPMAP_NEAREST and those after it
}

}  // namespace

GlFrame::GlFrame(Gl gl, const engine::Scene& scene, const engine::FrameSettings& settings)
    : gl_(gl), width_(settings.width), height_(settings.height) {
  geometry_ = program(kGeometryVertex, kGeometryFragment);
  transfer_ = program(kScreenVertex, "#version 330\n#define N " + std::to_string(settings.transfer.samples) + kTransferFragment);
  filter_ = program(kScreenVertex, kFilterFragment);
  surface_ = target(kRgba32F, kRgba, kFloat);
  albedo_ = target(kRgba8, kRgba, kByte);
  sums_ = target(kRgba16F, kRgba, kFloat);
  picture_ = target(kRgba8, kRgba, kByte);
  gl_.GenFramebuffers(3, framebuffers_);
  attach(framebuffers_[0], {surface_, albedo_}, target(kDepth32F, kDepthComponent, kFloat));
  attach(framebuffers_[1], {sums_}, 0);
  attach(framebuffers_[2], {picture_}, 0);
  gl_.GenVertexArrays(1, &noVertices_);
  upload(scene, settings);
  setUniforms(settings);
  gl_.Viewport(0, 0, width_, height_);
  gl_.ClearColor(0, 0, 0, 0);
  if (const unsigned wrong = gl_.GetError()) throw std::runtime_error("OpenGL's error " + std::to_string(wrong));
}

unsigned GlFrame::program(const std::string& vertex, const std::string& fragment) {
  const unsigned p = gl_.CreateProgram();
  const auto add = [&](unsigned type, const std::string& text) {
    const unsigned shader = gl_.CreateShader(type);
    const char* source = text.c_str();
    gl_.ShaderSource(shader, 1, &source, nullptr);
    gl_.CompileShader(shader);
    gl_.AttachShader(p, shader);
  };
  add(kVertexShader, vertex);
  add(kFragmentShader, fragment);
  gl_.LinkProgram(p);
  int linked = 0;
  gl_.GetProgramiv(p, kLinked, &linked);
  if (!linked) throw std::runtime_error("OpenGL does not take a shader");
  return p;
}

unsigned GlFrame::target(unsigned internal, unsigned format, unsigned type) {
  unsigned t = 0;
  gl_.GenTextures(1, &t);
  bind(0, t);
  gl_.TexImage2D(kTexture2D, 0, int(internal), width_, height_, 0, format, type, nullptr);
  gl_.TexParameteri(kTexture2D, kMinFilter, kNearest);
  gl_.TexParameteri(kTexture2D, kMagFilter, kNearest);
  return t;
}

void GlFrame::attach(unsigned framebuffer, const std::vector<unsigned>& colors, unsigned depth) {
  gl_.BindFramebuffer(kFramebuffer, framebuffer);
  std::vector<unsigned> attachments;
  for (const unsigned color : colors) {
    attachments.push_back(kColor0 + unsigned(attachments.size()));
    gl_.FramebufferTexture2D(kFramebuffer, attachments.back(), kTexture2D, color, 0);
  }
  if (depth) gl_.FramebufferTexture2D(kFramebuffer, kDepthAttachment, kTexture2D, depth, 0);
  gl_.DrawBuffers(int(attachments.size()), attachments.data());
  if (gl_.CheckFramebufferStatus(kFramebuffer) != kComplete) throw std::runtime_error("OpenGL cannot draw into such textures");
}

void GlFrame::bind(int unit, unsigned texture) {
  gl_.ActiveTexture(kTexture0 + unsigned(unit));
  gl_.BindTexture(kTexture2D, texture);
}

void GlFrame::upload(const engine::Scene& scene, const engine::FrameSettings& settings) {
  std::vector<unsigned> textures;
  for (const engine::Texture& texture : scene.textures) {
    const raster::TextureView& t = texture.view;
    gl_.GenTextures(1, &textures.emplace_back());
    bind(0, textures.back());
    const uint32_t* texels = t.texels.data();
    const int levels = t.mip == raster::MipFilter::None ? 1 : t.levels;
    for (int k = 0; k < levels; ++k) {
      const int w = std::max(1, t.width >> k), h = std::max(1, t.height >> k);
      gl_.TexImage2D(kTexture2D, k, int(t.srgb ? kSrgb8Alpha8 : kRgba8), w, h, 0, kRgba, kByte, texels);
      texels += size_t(w) * size_t(h);
    }
    for (const auto& [name, value] : {std::pair{kMaxLevel, unsigned(levels - 1)}, {kMinFilter, minFilterOf(t)},
                                      {kMagFilter, t.magFilter == raster::Filter::Linear ? kLinear : kNearest},
                                      {kWrapS, wrapOf(t.wrapU)}, {kWrapT, wrapOf(t.wrapV)}})
      gl_.TexParameteri(kTexture2D, name, int(value));
  }
  std::vector<unsigned> arrays;
  for (const engine::Mesh& m : scene.meshes) {
    gl_.GenVertexArrays(1, &arrays.emplace_back());
    gl_.BindVertexArray(arrays.back());
    const auto buffer = [&](unsigned kind, const auto& values) {
      unsigned b = 0;
      gl_.GenBuffers(1, &b);
      gl_.BindBuffer(kind, b);
      gl_.BufferData(kind, intptr_t(values.size() * sizeof values[0]), values.data(), kStaticDraw);
    };
    const auto stream = [&](unsigned location, const auto& values) {
      if (values.empty()) return;
      buffer(kArrayBuffer, values);
      gl_.EnableVertexAttribArray(location);
      gl_.VertexAttribPointer(location, int(sizeof values[0] / sizeof(float)), kFloat, 0, 0, nullptr);
    };
    stream(0, m.positions);
    stream(1, m.normals);
    stream(2, m.uvs[scene.materials[m.material].baseColorMap.uvSet]);
    stream(3, m.colors);
    buffer(kElementBuffer, m.indices);
  }
  gl_.VertexAttrib4f(1, 0, 0, 0, 0);  // where a mesh has none: normals are the triangle's, colours white
  gl_.VertexAttrib4f(3, 1, 1, 1, 1);
  for (const engine::Instance& i : scene.instances) {
    const engine::Mesh& mesh = scene.meshes[i.mesh];
    const raster::Material& m = scene.materials[mesh.material];
    Draw d = {};
    d.vertexArray = arrays[i.mesh];
    d.indices = int(mesh.indices.size());
    d.texture = m.baseColorMap.texture < 0 ? 0 : textures[size_t(m.baseColorMap.texture)];
    d.culled = !m.doubleSided;
    const glm::dmat4 view = settings.camera.viewFromWorld * i.worldFromObject;
    d.mirrored = glm::determinant(glm::dmat3(view)) < 0;
    const glm::dmat3 normal = glm::transpose(glm::inverse(glm::dmat3(view)));
    for (int c = 0; c < 4; ++c)
      for (int r = 0; r < 4; ++r) d.viewFromObject[size_t(4 * c + r)] = float(view[c][r]);
    for (int c = 0; c < 3; ++c)
      for (int r = 0; r < 3; ++r) d.viewFromNormal[size_t(3 * c + r)] = float(normal[c][r]);
    for (int c = 0; c < 4; ++c) d.baseColor[c] = m.baseColor[c];
    std::copy(m.baseColorMap.uvFromUv.begin(), m.baseColorMap.uvFromUv.end(), d.uvRows);
    d.cutoff = m.alphaMode == raster::AlphaMode::Mask ? m.alphaCutoff : -1;
    draws_.push_back(d);
  }
}

void GlFrame::setUniforms(const engine::FrameSettings& s) {
  const raster::Camera& c = s.camera;
  const post::Projector p = post::makeProjector(c, width_, height_);
  const float projection[] = {c.xScale, c.yScale, c.xShift, c.yShift}, toPixels[] = {p.xScale, p.yScale, p.xCenter, p.yCenter};
  const float range = c.zFar - c.zNear;  // without a far plane it is infinitely far away
  const float depth[] = {c.zFar > 0 ? (c.zFar + c.zNear) / range : 1, c.zFar > 0 ? -2 * c.zFar * c.zNear / range : -2 * c.zNear};
  const auto at = [&](unsigned program, const char* name) { return gl_.GetUniformLocation(program, name); };
  gl_.UseProgram(geometry_);
  gl_.Uniform4fv(at(geometry_, "projection"), 1, projection);
  gl_.Uniform2fv(at(geometry_, "depth"), 1, depth);
  gl_.UseProgram(transfer_);
  gl_.Uniform1i(at(transfer_, "albedo"), 1);
  gl_.Uniform4fv(at(transfer_, "toPixels"), 1, toPixels);
  gl_.Uniform1f(at(transfer_, "radius"), s.transfer.radius);
  gl_.Uniform1f(at(transfer_, "bias"), s.transfer.bias);
  gl_.Uniform1f(at(transfer_, "zNear"), c.zNear);
  gl_.Uniform3fv(at(transfer_, "xyz"), s.transfer.samples, &post::transferSamples(s.transfer)[0].x);
  gl_.Uniform2fv(at(transfer_, "turns"), 16, &post::rotations()[0].x);
  gl_.UseProgram(filter_);
  gl_.Uniform1i(at(filter_, "albedo"), 1);
  gl_.Uniform1i(at(filter_, "transfer"), 2);
  gl_.Uniform1f(at(filter_, "threshold"), s.transfer.filterThreshold);
}

void GlFrame::setDraw(const Draw& d) {
  const auto at = [&](const char* name) { return gl_.GetUniformLocation(geometry_, name); };
  gl_.UniformMatrix4fv(at("viewFromObject"), 1, 0, d.viewFromObject.data());
  gl_.UniformMatrix3fv(at("viewFromNormal"), 1, 0, d.viewFromNormal.data());
  gl_.Uniform4fv(at("baseColor"), 1, d.baseColor);
  gl_.Uniform3fv(at("uvRows"), 2, d.uvRows);
  gl_.Uniform1f(at("cutoff"), d.cutoff);
  gl_.Uniform1i(at("textured"), d.texture != 0);
  bind(0, d.texture);
  (d.culled ? gl_.Enable : gl_.Disable)(kCullFace);
  gl_.FrontFace(d.mirrored ? kCounterClockwise : kClockwise);
  gl_.BindVertexArray(d.vertexArray);
}

GlTimings GlFrame::render() {
  GlTimings times;
  raster::Stopwatch watch;
  gl_.BindFramebuffer(kFramebuffer, framebuffers_[0]);
  gl_.Enable(kDepthTest);
  gl_.Clear(kColorAndDepth);
  gl_.UseProgram(geometry_);
  for (const Draw& d : draws_) {
    setDraw(d);
    gl_.DrawElements(kTriangles, d.indices, kUint, nullptr);
  }
  gl_.Finish();
  times.gbuffer = watch.lap();

  gl_.Disable(kDepthTest);
  gl_.Disable(kCullFace);
  gl_.BindVertexArray(noVertices_);
  bind(0, surface_);
  bind(1, albedo_);
  bind(2, sums_);
  gl_.BindFramebuffer(kFramebuffer, framebuffers_[1]);
  gl_.UseProgram(transfer_);
  gl_.DrawArrays(kTriangles, 0, 3);
  gl_.Finish();
  times.transfer = watch.lap();

  gl_.BindFramebuffer(kFramebuffer, framebuffers_[2]);
  gl_.UseProgram(filter_);
  gl_.DrawArrays(kTriangles, 0, 3);
  gl_.Finish();
  times.filter = watch.lap();
  return times;
}

std::string GlFrame::renderer() const { return reinterpret_cast<const char*>(gl_.GetString(kRenderer)); }

std::vector<uint8_t> GlFrame::pixels() {
  std::vector<uint8_t> out(size_t(width_) * size_t(height_) * 4);
  gl_.BindFramebuffer(kFramebuffer, framebuffers_[2]);
  gl_.ReadPixels(0, 0, width_, height_, kRgba, kByte, out.data());
  return out;
}

}  // namespace obscura::apps
