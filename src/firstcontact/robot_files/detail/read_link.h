/// @file
/// Reads the links of a URDF.

#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include <firstcontact/robot/robot_description.h>
#include <firstcontact/robot_files/detail/urdf_context.h>

namespace firstcontact::detail {

/// Reads links, then makes the shapes of those that are asked for.
class LinkReader {
 public:
  /// @param context  outlives the reader
  explicit LinkReader(const UrdfContext& context) : context_(context) {}

  /// Reads a link without shapes; its errors go into the log.
  ///
  /// Its collision geometry is the geometry that can touch by the options.
  ///
  /// @param index  index of the link in the robot
  [[nodiscard]] Link read(const XmlElement& element, std::size_t index);

  /// Makes the shapes that are asked for. Errors go into the log.
  void make_shapes(std::vector<Link>& links);

  /// The reports of the mesh files that were read, in the order of their first use.
  [[nodiscard]] const std::vector<FileReport>& mesh_files() const { return mesh_files_; }

  /// Warns of links that have <visual> geometry, but nothing that can touch, where others have.
  void warn_of_links_that_cannot_touch(const std::vector<Link>& links) const;

 private:
  struct Wanted {
    std::size_t link;
    bool is_visual;
    std::size_t geometry;
    const XmlElement* element;
  };
  using MeshKey = std::pair<std::filesystem::path, std::array<double, 3>>;

  [[nodiscard]] std::vector<LinkGeometry> geometries(const XmlElement& link, bool is_visual,
                                                     bool is_wanted, std::size_t index);
  [[nodiscard]] std::optional<LinkGeometry> geometry(const XmlElement& piece, bool is_visual,
                                                     bool is_wanted) const;
  [[nodiscard]] const XmlElement* source_element(const XmlElement& holder) const;
  [[nodiscard]] GeometrySource source(const XmlElement& element, bool is_wanted) const;
  [[nodiscard]] GeometrySource primitive(const XmlElement& element) const;
  [[nodiscard]] MeshGeometry mesh(const XmlElement& element, bool is_wanted) const;
  [[nodiscard]] double size(const XmlElement& element, const char* attribute) const;
  void warn_of_size_zero(const XmlElement& element, const GeometrySource& source) const;
  [[nodiscard]] Shape shape(const XmlElement& element, const GeometrySource& source);
  [[nodiscard]] Shape read_mesh_shape(const GeometrySource& source);

  const UrdfContext& context_;
  std::vector<Wanted> wanted_;
  std::map<MeshKey, Shape> meshes_;
  std::vector<FileReport> mesh_files_;
};

/// Reads an <inertial>. Wrong values become its defect, and are reported in the log.
[[nodiscard]] LinkInertia read_inertia(const XmlElement& link, const XmlElement& inertial,
                                       const UrdfContext& context);

}  // namespace firstcontact::detail
