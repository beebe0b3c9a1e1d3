// SPDX-License-Identifier: BSD-3-Clause
// Whether a GPU would build voxmaps faster (Tripicchio et al., section 4.1). OpenGL compute writes the faces
// of a ring gear of some 200,000 triangles into the nodes of their bricks, in double precision; the time is
// compared with buildVoxMap() on one core and on all cores. The GPU's side leaves out edges, vertices and
// 16-bit bricks, which would take more time.
//
//   vps_bench_gpu           maps of 256^3 and 512^3
//   vps_bench_gpu --check   a small gear, and tests only that nodes have the bits that the processor computes
//                           from the same planes, and are no nearer to the surface than in the voxmap
#include <epoxy/gl.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <limits>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

#include "benchmarks/scene_parts.h"
#include "core/machine.h"
#include "gl/egl_context.h"
#include "vps/voxmap.h"

namespace vps::bench {
namespace {

constexpr double kBand = 4;  // voxels
constexpr int kCells = VoxMap::kBrick, kNodes = kCells + 1;
constexpr std::size_t kNodesOfBrick = std::size_t{kNodes} * kNodes * kNodes;
constexpr int kRepeats = 5;

template <typename Run>
double secondsOf(Run run) {
  const double begun_s = scenes::wallSeconds();
  run();
  return scenes::wallSeconds() - begun_s;
}

double median(std::vector<double> values) {
  std::ranges::sort(values);
  return values[values.size() / 2];
}

/// The input of both sides, in voxels: the plane of each face and of its three sides, and for each brick
/// within the band of a face the faces that may reach the brick.
struct Faces {
  using Plane = std::array<double, 4>;  // normal and offset
  std::vector<std::array<Plane, 4>> planes;
  std::vector<std::array<std::int32_t, 4>> bricks;  // first node of each brick; the fourth number is not used
  std::vector<std::uint32_t> first, list;           // of brick i: list[first[i]] to list[first[i + 1]]

  Faces(const Mesh& mesh, double voxel_m) {
    std::map<std::array<int, 3>, std::vector<std::uint32_t>> of_brick;
    for (const auto& [a, b, c] : mesh.triangles) {
      const std::array<Vec3, 3> p = {mesh.vertices[a] / voxel_m, mesh.vertices[b] / voxel_m,
                                     mesh.vertices[c] / voxel_m};
      const Vec3 n = (p[1] - p[0]).cross(p[2] - p[0]).normalized();
      const auto planeThrough = [](const Vec3& normal, const Vec3& at) {
        return Plane{normal.x(), normal.y(), normal.z(), -normal.dot(at)};
      };
      std::array<Plane, 4> of_face = {planeThrough(n, p[0])};
      Box box;
      for (std::size_t k = 0; k < 3; ++k) {
        of_face[k + 1] = planeThrough(n.cross(p[(k + 1) % 3] - p[k]), p[k]);
        box.add(p[k]);
      }
      box = {box.min - kBand * n.cwiseAbs(), box.max + kBand * n.cwiseAbs()};
      const Vec3 low = (box.min / kCells).array().floor(), high = (box.max / kCells).array().floor();
      for (int x = static_cast<int>(low.x()); x <= high.x(); ++x)
        for (int y = static_cast<int>(low.y()); y <= high.y(); ++y)
          for (int z = static_cast<int>(low.z()); z <= high.z(); ++z)
            of_brick[{x, y, z}].push_back(static_cast<std::uint32_t>(planes.size()));
      planes.push_back(of_face);
    }
    first.push_back(0);
    for (const auto& [at, faces] : of_brick) {
      bricks.push_back({kCells * at[0], kCells * at[1], kCells * at[2], 0});
      list.insert(list.end(), faces.begin(), faces.end());
      first.push_back(static_cast<std::uint32_t>(list.size()));
    }
  }
};

/// The signed distance to the nearest face whose prism contains the node; of two equal distances, the first.
float nodeOf(const Faces& faces, std::size_t brick, int x, int y, int z) {
  const double px = faces.bricks[brick][0] + x, py = faces.bricks[brick][1] + y,
               pz = faces.bricks[brick][2] + z;
  float best = std::numeric_limits<float>::max();
  for (std::uint32_t k = faces.first[brick]; k < faces.first[brick + 1]; ++k) {
    const auto& planes = faces.planes[faces.list[k]];
    const auto at = [&](std::size_t i) {
      return planes[i][0] * px + planes[i][1] * py + planes[i][3] + planes[i][2] * pz;
    };
    if (std::min({at(1), at(2), at(3)}) < 0 || std::abs(at(0)) >= kBand) continue;
    const auto d = static_cast<float>(at(0));
    if (std::abs(d) < std::abs(best)) best = d;
  }
  return best;
}

// A work group for each brick, an invocation for each of its 9 x 9 rows. `precise` forbids fused operations,
// whose rounding differs from that of the processor.
constexpr const char* kShader = R"(#version 450
layout(local_size_x = 81) in;
layout(std430, binding = 0) readonly buffer Planes { dvec4 planes[]; };
layout(std430, binding = 1) readonly buffer First { uint first[]; };
layout(std430, binding = 2) readonly buffer List { uint list[]; };
layout(std430, binding = 3) readonly buffer Bricks { ivec4 bricks[]; };
layout(std430, binding = 4) writeonly buffer Nodes { float nodes[]; };
uniform double band;
double along(uint plane, dvec3 p) {
  dvec4 n = planes[plane];
  precise double at = n.x * p.x + n.y * p.y + n.w + n.z * p.z;
  return at;
}
void main() {
  uint brick = gl_WorkGroupID.x + gl_WorkGroupID.y * 32768u;
  if (brick >= uint(bricks.length())) return;
  uint row = gl_LocalInvocationID.x;
  float best[9];
  for (int z = 0; z < 9; ++z) best[z] = 3.402823466e38;
  for (uint k = first[brick]; k < first[brick + 1u]; ++k) {
    uint plane = 4u * list[k];
    for (int z = 0; z < 9; ++z) {
      dvec3 p = dvec3(bricks[brick].xyz + ivec3(int(row / 9u), int(row % 9u), z));
      double d = along(plane, p);
      if (min(min(along(plane + 1u, p), along(plane + 2u, p)), along(plane + 3u, p)) < 0.0 || abs(d) >= band)
        continue;
      float rounded = float(d);
      if (abs(rounded) < abs(best[z])) best[z] = rounded;
    }
  }
  for (int z = 0; z < 9; ++z) nodes[brick * 729u + row * 9u + uint(z)] = best[z];
})";

GLuint compiled() {
  const GLuint shader = glCreateShader(GL_COMPUTE_SHADER), program = glCreateProgram();
  glShaderSource(shader, 1, &kShader, nullptr);
  glCompileShader(shader);
  glAttachShader(program, shader);
  glLinkProgram(program);
  GLint is_linked = 0;
  glGetProgramiv(program, GL_LINK_STATUS, &is_linked);
  if (is_linked == 0) {
    std::array<char, 1000> log{}, link_log{};
    glGetShaderInfoLog(shader, log.size(), nullptr, log.data());
    glGetProgramInfoLog(program, link_log.size(), nullptr, link_log.data());
    throw std::runtime_error(std::string("the driver does not take the shader: ") + log.data() +
                             link_log.data());
  }
  glDeleteShader(shader);
  return program;
}

struct GpuTimes {
  double upload_s = 0, run_s = 0, download_s = 0;
};

GpuTimes runOnGpu(GLuint program, const Faces& faces, std::vector<float>& nodes) {
  GpuTimes times;
  std::array<GLuint, 5> buffers{};
  glGenBuffers(static_cast<GLsizei>(buffers.size()), buffers.data());
  nodes.resize(faces.bricks.size() * kNodesOfBrick);
  const auto bytesOf = [](const auto& values) {
    return static_cast<GLsizeiptr>(values.size() * sizeof(values[0]));
  };
  times.upload_s = secondsOf([&] {
    GLuint binding = 0;
    const auto put = [&](GLsizeiptr bytes, const void* data) {
      glBindBufferBase(GL_SHADER_STORAGE_BUFFER, binding, buffers[binding]);
      glBufferData(GL_SHADER_STORAGE_BUFFER, bytes, data, GL_STATIC_DRAW);
      ++binding;
    };
    put(bytesOf(faces.planes), faces.planes.data());
    put(bytesOf(faces.first), faces.first.data());
    put(bytesOf(faces.list), faces.list.data());
    put(bytesOf(faces.bricks), faces.bricks.data());
    put(bytesOf(nodes), nullptr);
    glFinish();
  });
  times.run_s = secondsOf([&] {
    const auto groups = static_cast<GLuint>(faces.bricks.size());
    glUseProgram(program);
    glUniform1d(glGetUniformLocation(program, "band"), kBand);
    glDispatchCompute(std::min(groups, 32768U), (groups + 32767U) / 32768U, 1);
    glMemoryBarrier(GL_ALL_BARRIER_BITS);
    glFinish();
  });
  times.download_s =
      secondsOf([&] { glGetBufferSubData(GL_SHADER_STORAGE_BUFFER, 0, bytesOf(nodes), nodes.data()); });
  glDeleteBuffers(static_cast<GLsizei>(buffers.size()), buffers.data());
  if (const GLenum error = glGetError(); error != GL_NO_ERROR)
    throw std::runtime_error("OpenGL error " + std::to_string(error));
  return times;
}

std::size_t differingNodes(const Faces& faces, const std::vector<float>& nodes) {
  std::vector<std::size_t> of_brick(faces.bricks.size());
  tbb::parallel_for(std::size_t{0}, of_brick.size(), [&](std::size_t b) {
    const float* node = nodes.data() + b * kNodesOfBrick;
    for (int x = 0; x < kNodes; ++x)
      for (int y = 0; y < kNodes; ++y)
        for (int z = 0; z < kNodes; ++z, ++node) {
          const float expected = nodeOf(faces, b, x, y, z);
          of_brick[b] += std::memcmp(&expected, node, sizeof expected) != 0 ? 1 : 0;
        }
  });
  std::size_t sum = 0;
  for (const std::size_t one : of_brick) sum += one;
  return sum;
}

/// Comparison of the nodes with those of the voxmap, whose surface also has edges and vertices.
struct Agreement {
  std::size_t equal = 0, farther = 0, nearer = 0;
};

Agreement agreementWith(const VoxMap& map, double voxel_m, const Faces& faces,
                        const std::vector<float>& nodes) {
  // Half a quantum of the map, 1/65534 of the band, and the border by which a face reaches over its sides.
  constexpr double kSame = kBand / 65534 + 1e-6;
  Agreement out;
  for (std::size_t b = 0; b < faces.bricks.size(); ++b)
    for (std::size_t i = 0; i < kNodesOfBrick; ++i) {
      const double d = std::abs(nodes[b * kNodesOfBrick + i]);
      if (d > kBand - 1e-3) continue;
      const auto offset = static_cast<int>(i);
      const Vec3 node(faces.bricks[b][0] + offset / (kNodes * kNodes),
                      faces.bricks[b][1] + offset / kNodes % kNodes, faces.bricks[b][2] + offset % kNodes);
      const double of_map = std::abs(map.distance(voxel_m * node)) / voxel_m;
      ++(std::abs(d - of_map) <= kSame ? out.equal : d > of_map ? out.farther : out.nearer);
    }
  return out;
}

double buildSeconds(const Mesh& mesh, double voxel_m, std::size_t threads) {
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
  std::vector<double> times;
  for (int i = 0; i < kRepeats; ++i)
    times.push_back(secondsOf([&] { static_cast<void>(buildVoxMap(mesh, {voxel_m, kBand})); }));
  return median(times);
}

std::size_t allCores() {
  return tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism);
}

bool row(GLuint program, int voxels, int coarser, bool is_timed) {
  const Mesh mesh = test::makeRingGear(ringShape(coarser));
  const double voxel_m = bounds(mesh).size().maxCoeff() / voxels;
  double sort_s = scenes::wallSeconds();
  const Faces faces(mesh, voxel_m);
  sort_s = scenes::wallSeconds() - sort_s;
  std::vector<float> nodes;
  std::array<std::vector<double>, 3> times;
  for (int i = 0; i < (is_timed ? kRepeats : 1); ++i) {
    const GpuTimes one = runOnGpu(program, faces, nodes);
    times[0].push_back(one.upload_s);
    times[1].push_back(one.run_s);
    times[2].push_back(one.download_s);
  }
  const std::size_t differing = differingNodes(faces, nodes);
  const auto within = static_cast<std::size_t>(
      std::ranges::count_if(nodes, [](float d) { return std::abs(d) < std::numeric_limits<float>::max(); }));
  const Agreement with_map = agreementWith(buildVoxMap(mesh, {voxel_m, kBand}), voxel_m, faces, nodes);
  std::printf(
      "%d^3: %zu triangles, %zu bricks; %zu of %zu nodes in reach of a face have other bits than the "
      "processor's\n"
      "  compared with the voxmap: %zu equal, %zu farther, where an edge or vertex is nearer, %zu nearer\n",
      voxels, mesh.triangles.size(), faces.bricks.size(), differing, within, with_map.equal, with_map.farther,
      with_map.nearer);
  if (is_timed)
    std::printf(
        "  GPU, faces alone [ms]: upload %.1f, compute %.1f, download %.1f (sorting into bricks, one core, "
        "%.0f)\n"
        "  buildVoxMap, all of it [ms]: one core %.0f, all %zu %.0f\n",
        1e3 * median(times[0]), 1e3 * median(times[1]), 1e3 * median(times[2]), 1e3 * sort_s,
        1e3 * buildSeconds(mesh, voxel_m, 1), allCores(), 1e3 * buildSeconds(mesh, voxel_m, allCores()));
  return differing == 0 && with_map.nearer == 0 && with_map.equal > 9 * with_map.farther;
}

int run(bool is_check) {
  double begun_s = scenes::wallSeconds();
  const viewer::EglContext context;
  const viewer::EglContext::Current current(context);
  const auto* name = reinterpret_cast<const char*>(glGetString(GL_RENDERER));
  const double context_s = scenes::wallSeconds() - begun_s;
  begun_s = scenes::wallSeconds();
  const GLuint program = compiled();
  const double compile_s = scenes::wallSeconds() - begun_s;
  bool is_good = true;
  if (is_check) {
    is_good = row(program, 48, 8, false);
  } else {
    std::printf("%s: context %.0f ms, shader %.0f ms, once in a process\n", name, 1e3 * context_s,
                1e3 * compile_s);
    for (const int voxels : {256, 512}) is_good &= row(program, voxels, 1, true);
  }
  glDeleteProgram(program);
  return is_good ? EXIT_SUCCESS : EXIT_FAILURE;
}

}  // namespace
}  // namespace vps::bench

int main(int argc, char** argv) {
  try {
    return vps::bench::run(argc == 2 && std::string(argv[1]) == "--check");
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 2;
  }
}
