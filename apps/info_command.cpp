#include "info_command.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <fmt/core.h>

#include <firstcontact/geometry/mesh_defects.h>
#include <firstcontact/geometry/weld.h>
#include <firstcontact/mesh_files/read_mesh.h>
#include <firstcontact/mesh_files/read_points.h>
#include <firstcontact/robot_files/read_urdf.h>
#include <firstcontact/text/file_extension.h>
#include <firstcontact/text/parse_error.h>

#include "file_text.h"
#include "info_json.h"
#include "print_robot.h"
#include "quantity_text.h"
#include "standard_streams.h"
#include "terminal_text.h"

namespace firstcontact::app {
namespace {

void line(const char* label, const std::string& value) {
  say(fmt::format("  {:<22} {}\n", label, visible(value)));
}

/// Prints a count; silent for 0.
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

/// A point as text, without a sign on zero.
std::string point(Eigen::Vector3d p) {
  p += Eigen::Vector3d::Zero();
  return fmt::format("({:.6g}, {:.6g}, {:.6g})", p.x(), p.y(), p.z());
}

/// Prints the unit of lengths, and whether the size is likely in it.
void print_unit(const FileReport& report, double size) {
  constexpr double kImplausible = 100.0;  // [m]
  line("unit", report.unit.empty() ? "none in the file: metres are taken" : report.unit);
  if (size >= kImplausible) {
    line("warning", fmt::format("{} across: is the unit right? If the file is in millimetres, "
                                "\"scale\": 0.001 reads it so (--environment-scale 0.001 on the "
                                "command line, scale=0.001 in Python)",
                                length_text(size)));
  }
}

void print_bounds(const Eigen::AlignedBox3d& bounds, const FileReport& report) {
  line("bounds", fmt::format("{} ... {} m", point(bounds.min()), point(bounds.max())));
  const Eigen::Vector3d size = bounds.sizes();
  line("size", fmt::format("{} x {} x {}", length_text(size.x()), length_text(size.y()),
                           length_text(size.z())));
  print_unit(report, size.maxCoeff());
}

/// Prints the report on the file.
void print_report(const FileReport& report) {
  line("format", report.format);
  if (const std::string left_out = left_out_text(report); !left_out.empty()) {
    line("left out", left_out);
  }
  for (const std::string& file : report.also_read) {
    line("also read", file);
  }
  for (const std::string& warning : report.warnings) {
    line("warning", warning);
  }
}

void print(const std::string& name, const Mesh& mesh, const MeshDefects& found,
           const FileReport& report) {
  say(visible(name) + "\n");
  line("triangles", fmt::format("{}", mesh.triangles.size()));
  line("vertices", fmt::format("{} of different position", mesh.vertices.size()));
  line("edges", fmt::format("{}", found.edges));
  line("components", fmt::format("{}", found.components));
  line("surface", surface(found));
  print_bounds(found.bounds, report);
  if (found.signed_volume) {
    line("volume", fmt::format("{:.6g} m^3", *found.signed_volume));
  }
  count("open edges", found.open_edges);
  count("non-manifold edges", found.nonmanifold_edges);
  count("degenerate triangles", found.degenerate_triangles);
  count("doubled triangles", found.doubled_triangles);
  count("unused vertices", found.unused_vertices);
  print_report(report);
}

void print(const std::string& name, const std::vector<Eigen::Vector3d>& points,
           const FileReport& report) {
  Eigen::AlignedBox3d bounds;
  for (const Eigen::Vector3d& p : points) {
    bounds.extend(p);
  }
  say(visible(name) + "\n");
  line("points", fmt::format("{}", points.size()));
  Mesh mesh{.vertices = points, .triangles = {}};
  count("points at one place", weld(mesh));
  print_bounds(bounds, report);
  print_report(report);
}

bool can_read_points(const std::string& file, const ReadingOptions& options) {
  try {
    return !read_points_file(file, options).points.empty();
  } catch (const ParseError&) {
    return false;
  }
}

/// Whether a file is a cloud; only PLY files may be either.
bool is_cloud(const std::string& file, const ReadingOptions& options) {
  const std::string extension = std::filesystem::path(file).extension().string();
  if (extension != ".ply" && extension != ".PLY") {
    return extension == ".pcd" || extension == ".PCD" || extension == ".xyz" || extension == ".XYZ";
  }
  try {
    (void)read_mesh_file(file, options);
  } catch (const ParseError&) {
    return can_read_points(file, options);
  }
  return false;
}

bool is_robot(const std::string& file) { return detail::file_extension(file) == "urdf"; }

/// Requires the name of a mesh, cloud or robot.
void require_mesh(const std::string& file) {
  const std::string ending = detail::file_extension(file);
  constexpr std::array kMeshes{"obj", "stl", "ply", "off", "dae", "glb", "gltf"};
  if (std::ranges::find(kMeshes, ending) == kMeshes.end()) {
    throw ParseError(
        file, fmt::format("expected a mesh (.obj, .stl, .ply, .off, .dae, .glb, .gltf), a cloud "
                          "(.ply, .pcd, .xyz) or a robot (.urdf), got \"{}{}\"{}",
                          ending.empty() ? "" : ".", ending,
                          ending == "json" || ending == "jsonl"
                              ? "; of a scene `firstcontact check --explain` says what is read"
                              : ""));
  }
}

struct InfoArguments {
  std::vector<std::string> files;
  std::vector<std::string> package_roots;
  bool visual_where_missing = false;
  bool in_contact = false;
  bool json = false;
  bool lenient = false;

  [[nodiscard]] ReadingOptions reading() const { return {.lenient = lenient}; }
};

void inform_robot(const std::string& file, const InfoArguments& arguments) {
  UrdfOptions options;
  options.package_roots.assign(arguments.package_roots.begin(), arguments.package_roots.end());
  if (arguments.visual_where_missing) {
    options.surface = RobotSurface::collision_or_visual;
  }
  options.reading = arguments.reading();
  const RobotReading robot = read_robot(file, options);
  if (arguments.in_contact) {
    print_always_in_contact(robot.model);
  } else if (arguments.json) {
    fmt::print("{}", robot_json(file, robot));
  } else {
    print_robot(file, robot);
  }
}

void inform(const std::string& file, const InfoArguments& arguments) {
  if (is_robot(file)) {
    inform_robot(file, arguments);
  } else if (arguments.in_contact) {
    throw ParseError(file, "--always-in-contact expects a robot, a .urdf file");
  } else if (is_cloud(file, arguments.reading())) {
    const PointReading cloud = read_points_file(file, arguments.reading());
    arguments.json ? fmt::print("{}", points_json(file, cloud))
                   : print(file, cloud.points, cloud.report);
  } else {
    require_mesh(file);
    const MeshReading reading = read_mesh_file(file, arguments.reading());
    const MeshDefects found = inspect(reading.mesh);
    arguments.json ? fmt::print("{}", mesh_json(file, reading, found))
                   : print(file, reading.mesh, found, reading.report);
  }
}

}  // namespace

void add_info_command(CLI::App& app) {
  CLI::App* command =
      app.add_subcommand("info",
                         "Counts, defects, bounds and masses of meshes, clouds and robots, and "
                         "the parts of their files that are not used");
  auto arguments = std::make_shared<InfoArguments>();
  command
      ->add_option("FILE", arguments->files,
                   "OBJ, STL, PLY, OFF, DAE, GLB or glTF mesh; PLY, PCD or XYZ cloud; URDF robot")
      ->required();
  command
      ->add_option("--package-root", arguments->package_roots,
                   "Folder of the packages that a robot names as package://; repeatable")
      ->type_name("FOLDER")
      ->allow_extra_args(false);
  command->add_flag("--visual-where-missing", arguments->visual_where_missing,
                    "Uses the visual geometry of links that have no collision geometry");
  command->add_flag("--json", arguments->json,
                    "Prints JSON in place of text for people, one line for each file");
  command->add_flag("--lenient", arguments->lenient,
                    "Unknown names in files are warnings, not errors");
  command
      ->add_flag(
          "--always-in-contact", arguments->in_contact,
          "Prints only the pairs of links that touch where each joint is at 0 or at its limit "
          "next to 0, as SRDF. Decide for each pair whether it may touch")
      ->excludes("--json");
  command->callback([arguments] {
    for (const std::string& file : arguments->files) {
      inform(file, *arguments);
    }
    flush_stdout();
  });
}

}  // namespace firstcontact::app
