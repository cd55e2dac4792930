#include "info_command.h"

#include <filesystem>
#include <memory>
#include <string>

#include <fmt/core.h>

#include <firstcontact/geometry/mesh_defects.h>
#include <firstcontact/geometry/read_mesh.h>

#include "quantity_text.h"

namespace firstcontact::app {
namespace {

void line(const char* label, const std::string& value) {
  fmt::print("  {:<22} {}\n", label, value);
}

/// Silent where there is nothing unusual.
void count(const char* label, std::size_t number) {
  if (number > 0) {
    line(label, fmt::format("{}", number));
  }
}

std::string surface(const MeshDefects& found) {
  if (!found.closed) {
    return "not closed";
  }
  return found.consistently_oriented ? "closed, consistently oriented"
                                     : "closed, not consistently oriented";
}

/// Without a sign on zero.
std::string point(Eigen::Vector3d p) {
  p += Eigen::Vector3d::Zero();
  return fmt::format("({:.6g}, {:.6g}, {:.6g})", p.x(), p.y(), p.z());
}

void print(const std::string& name, const Mesh& mesh, const MeshDefects& found) {
  fmt::print("{}\n", name);
  line("triangles", fmt::format("{}", mesh.triangles.size()));
  line("vertices", fmt::format("{} of different position", mesh.vertices.size()));
  line("edges", fmt::format("{}", found.edges));
  line("components", fmt::format("{}", found.components));
  line("surface", surface(found));
  line("bounds", fmt::format("{} ... {} m", point(found.bounds.min()), point(found.bounds.max())));
  const Eigen::Vector3d size = found.bounds.sizes();
  line("size", fmt::format("{} x {} x {}", length_text(size.x()), length_text(size.y()),
                           length_text(size.z())));
  if (found.signed_volume) {
    line("volume", fmt::format("{:.6g} m^3", *found.signed_volume));
  }
  count("open edges", found.open_edges);
  count("non-manifold edges", found.nonmanifold_edges);
  count("degenerate triangles", found.degenerate_triangles);
  count("doubled triangles", found.doubled_triangles);
  count("unused vertices", found.unused_vertices);
}

}  // namespace

void add_info_command(CLI::App& app) {
  CLI::App* command = app.add_subcommand("info", "Counts, defects and bounds of meshes");
  auto files = std::make_shared<std::vector<std::string>>();
  command->add_option("MESH", *files, "OBJ, STL, PLY, OFF, DAE, GLB or glTF file")->required();
  command->callback([files] {
    for (const std::string& file : *files) {
      const Mesh mesh = read_mesh(file);
      print(file, mesh, inspect(mesh));
    }
  });
}

}  // namespace firstcontact::app
