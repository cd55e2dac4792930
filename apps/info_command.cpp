#include "info_command.h"

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <fmt/core.h>

#include <firstcontact/articulated/read_urdf.h>
#include <firstcontact/geometry/mesh_defects.h>
#include <firstcontact/geometry/parse_error.h>
#include <firstcontact/geometry/read_mesh.h>
#include <firstcontact/geometry/read_points.h>
#include <firstcontact/geometry/weld.h>

#include "print_robot.h"
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

void print_bounds(const Eigen::AlignedBox3d& bounds) {
  constexpr double kImplausible = 1000.0;  // [m]
  line("bounds", fmt::format("{} ... {} m", point(bounds.min()), point(bounds.max())));
  const Eigen::Vector3d size = bounds.sizes();
  line("size", fmt::format("{} x {} x {}", length_text(size.x()), length_text(size.y()),
                           length_text(size.z())));
  if (size.maxCoeff() >= kImplausible) {
    line("unit", "is it right? metres are expected");
  }
}

void print(const std::string& name, const Mesh& mesh, const MeshDefects& found) {
  fmt::print("{}\n", name);
  line("triangles", fmt::format("{}", mesh.triangles.size()));
  line("vertices", fmt::format("{} of different position", mesh.vertices.size()));
  line("edges", fmt::format("{}", found.edges));
  line("components", fmt::format("{}", found.components));
  line("surface", surface(found));
  print_bounds(found.bounds);
  if (found.signed_volume) {
    line("volume", fmt::format("{:.6g} m^3", *found.signed_volume));
  }
  count("open edges", found.open_edges);
  count("non-manifold edges", found.nonmanifold_edges);
  count("degenerate triangles", found.degenerate_triangles);
  count("doubled triangles", found.doubled_triangles);
  count("unused vertices", found.unused_vertices);
}

void print(const std::string& name, const std::vector<Eigen::Vector3d>& points) {
  Eigen::AlignedBox3d bounds;
  for (const Eigen::Vector3d& p : points) {
    bounds.extend(p);
  }
  fmt::print("{}\n", name);
  line("points", fmt::format("{}", points.size()));
  Mesh mesh{.vertices = points, .triangles = {}};
  count("points at one place", weld(mesh));
  print_bounds(bounds);
}

bool can_read_points(const std::string& file) {
  try {
    return !read_points(file).empty();
  } catch (const ParseError&) {
    return false;
  }
}

/// Only PLY files may be either.
bool is_cloud(const std::string& file) {
  const std::string extension = std::filesystem::path(file).extension().string();
  if (extension != ".ply" && extension != ".PLY") {
    return extension == ".pcd" || extension == ".PCD" || extension == ".xyz" || extension == ".XYZ";
  }
  try {
    (void)read_mesh(file);
  } catch (const ParseError&) {
    return can_read_points(file);
  }
  return false;
}

bool is_robot(const std::string& file) {
  const std::string extension = std::filesystem::path(file).extension().string();
  return extension == ".urdf" || extension == ".URDF";
}

}  // namespace

void add_info_command(CLI::App& app) {
  CLI::App* command =
      app.add_subcommand("info", "Counts, defects and bounds of meshes, point clouds and robots");
  auto files = std::make_shared<std::vector<std::string>>();
  auto roots = std::make_shared<std::vector<std::string>>();
  command
      ->add_option("FILE", *files,
                   "OBJ, STL, PLY, OFF, DAE, GLB or glTF mesh; PLY, PCD or XYZ cloud; URDF robot")
      ->required();
  command
      ->add_option("--package-root", *roots,
                   "Folder that holds packages which a robot names as package://; repeatable")
      ->allow_extra_args(false);
  auto in_contact = std::make_shared<bool>(false);
  command->add_flag("--always-in-contact", *in_contact,
                    "Of robots only the pairs of links that touch where every coordinate is 0, or "
                    "its limit next to it, as SRDF; look whether each may");
  command->callback([files, roots, in_contact] {
    for (const std::string& file : *files) {
      if (is_robot(file)) {
        UrdfOptions options;
        options.package_roots.assign(roots->begin(), roots->end());
        const RobotModel robot = read_urdf(file, options);
        *in_contact ? print_always_in_contact(robot) : print_robot(file, robot);
      } else if (*in_contact) {
        throw ParseError(file, "--always-in-contact expects a robot, a .urdf file");
      } else if (is_cloud(file)) {
        print(file, read_points(file));
      } else {
        const Mesh mesh = read_mesh(file);
        print(file, mesh, inspect(mesh));
      }
    }
  });
}

}  // namespace firstcontact::app
