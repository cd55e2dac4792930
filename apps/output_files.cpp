#include "output_files.h"

#include <cstddef>
#include <span>
#include <stdexcept>
#include <system_error>
#include <variant>

#include <fmt/core.h>

#include <firstcontact/robot/link_geometry.h>
#include <firstcontact/scene/body_shape.h>

#include "atomic_file.h"

namespace firstcontact::app {
namespace {

/// Whether a write to one would change the other.
///
/// Pipes and devices, such as /dev/null, hold nothing that could be lost.
bool are_one_file(const std::filesystem::path& a, const std::filesystem::path& b) {
  std::error_code error;
  const auto status = std::filesystem::status(a, error);
  if (std::filesystem::exists(status)) {
    return std::filesystem::is_regular_file(status) && std::filesystem::equivalent(a, b, error);
  }
  return std::filesystem::weakly_canonical(std::filesystem::absolute(a, error), error) ==
         std::filesystem::weakly_canonical(std::filesystem::absolute(b, error), error);
}

void add_files(const BodyShape& shape, std::vector<std::filesystem::path>& files) {
  const auto add_file = [&files](const auto* source) {
    if (source != nullptr) {
      files.push_back(source->path);
    }
  };
  add_file(std::get_if<MeshFile>(&shape.source));
  add_file(std::get_if<PointFile>(&shape.source));
  add_file(std::get_if<HeightFile>(&shape.source));
  if (const auto* hull = std::get_if<ConvexHullShape>(&shape.source)) {
    add_file(std::get_if<MeshFile>(&hull->of));
  }
}

void add_files(std::span<const LinkGeometry> geometry, std::vector<std::filesystem::path>& files) {
  for (const LinkGeometry& one : geometry) {
    if (const auto* mesh = std::get_if<MeshGeometry>(&one.source)) {
      files.push_back(mesh->path);
    }
  }
}

}  // namespace

void require_named(const std::vector<OutputFile>& outputs) {
  for (const OutputFile& output : outputs) {
    if (output.path == "-") {
      throw std::invalid_argument(fmt::format(
          "{} -: expected the name of a file; for the standard output write {} /dev/stdout",
          output.option, output.option));
    }
  }
}

void require_different(const std::vector<OutputFile>& outputs) {
  for (std::size_t k = 0; k < outputs.size(); ++k) {
    for (std::size_t other = 0; other < k; ++other) {
      if (!outputs[k].path.empty() && !outputs[other].path.empty() &&
          are_one_file(outputs[k].path, outputs[other].path)) {
        throw std::invalid_argument(fmt::format("{} {}: this would overwrite the file of {}",
                                                outputs[k].option, outputs[k].path,
                                                outputs[other].option));
      }
    }
  }
}

void require_writable(const std::vector<OutputFile>& outputs) {
  for (const OutputFile& output : outputs) {
    std::error_code error;
    const auto status = std::filesystem::status(output.path, error);
    // A pipe may be opened once only.
    const bool is_file =
        !std::filesystem::exists(status) || std::filesystem::is_regular_file(status);
    if (!output.path.empty() && is_file) {
      const AtomicFile begun(output.path);  // Leaves nothing behind.
    }
  }
}

void require_no_input(const std::vector<OutputFile>& outputs,
                      const std::vector<std::filesystem::path>& inputs) {
  for (const OutputFile& output : outputs) {
    for (const std::filesystem::path& input : inputs) {
      if (!output.path.empty() && are_one_file(output.path, input)) {
        throw std::runtime_error(fmt::format("{} {}: this would overwrite an input, {}",
                                             output.option, output.path, input.string()));
      }
    }
  }
}

std::vector<std::filesystem::path> files_of(const Scene& scene) {
  std::vector<std::filesystem::path> files = scene.files_read;
  for (const Body& body : scene.bodies) {
    add_files(body.shape, files);
  }
  for (const SceneRobot& robot : scene.robots) {
    files.push_back(robot.file.urdf);
    files.push_back(robot.srdf);
    for (const Link& link : robot.model.links()) {
      add_files(link.collision, files);
      add_files(link.visual, files);
    }
  }
  return files;
}

}  // namespace firstcontact::app
