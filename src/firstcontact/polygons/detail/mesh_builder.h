/// @file
/// Collects vertices and polygons while a file is read.

#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include <firstcontact/geometry/mesh.h>
#include <firstcontact/text/parse_error.h>
#include <firstcontact/text/reading_log.h>

namespace firstcontact::detail {

/// A mesh under construction. Indices are checked at the end, as faces may stand before vertices.
class MeshBuilder {
 public:
  /// The unit in which places of polygons in the file count.
  enum class Place { line, byte };

  explicit MeshBuilder(Place places = Place::line) : places_(places) {}

  /// Reserves room for at most `count` items, and no more than the `bytes` left can hold.
  void reserve_vertices(std::uint64_t count, std::size_t bytes, std::size_t least_size) {
    mesh_.vertices.reserve(std::min<std::uint64_t>(count, bytes / least_size + 1));
  }
  void reserve_triangles(std::uint64_t count, std::size_t bytes, std::size_t least_size) {
    mesh_.triangles.reserve(std::min<std::uint64_t>(count, bytes / least_size + 1));
  }

  [[nodiscard]] std::size_t vertex_count() const { return mesh_.vertices.size(); }

  /// Adds a vertex. False where the vertex would have no number.
  [[nodiscard]] bool add_vertex(const Eigen::Vector3d& p) {
    if (mesh_.vertices.size() == std::numeric_limits<std::uint32_t>::max()) {
      return false;
    }
    mesh_.vertices.push_back(p);
    return true;
  }

  /// Begins a polygon whose place in the file, a line or a byte, is `place`.
  void begin_polygon(std::size_t place) {
    place_ = place;
    corners_ = 0;
    first_triangle_ = mesh_.triangles.size();
    holes_ = 0;
  }

  /// Begins a hole of the polygon: the corners that follow are its ring, of either orientation.
  void begin_hole() {
    if (corners_ > 0) {
      hole_begins_.push_back(static_cast<std::uint32_t>(corners_));
      ++holes_;
    }
  }

  /// Adds a corner to the polygon. False for an index that no vertex can have.
  [[nodiscard]] bool add_corner(std::int64_t index) {
    if (index < 0 || index >= std::numeric_limits<std::uint32_t>::max()) {
      return false;
    }
    const auto corner = static_cast<std::uint32_t>(index);
    if (corner >= greatest_.index_end) {
      greatest_ = {corner + 1, place_};
    }
    if (corners_ >= 2) {
      mesh_.triangles.push_back({first_, previous_, corner});
    }
    if (corners_ == 0) {
      first_ = corner;
    }
    previous_ = corner;
    ++corners_;
    return true;
  }

  /// Ends the polygon: one corner is a point, two are an edge. Returns its number of corners.
  std::size_t end_polygon() {
    if (corners_ == 1 || corners_ == 2) {
      mesh_.triangles.push_back({first_, previous_, previous_});
    }
    if (corners_ > 3) {
      note_polygon();
    } else {
      hole_begins_.resize(hole_begins_.size() - holes_);
    }
    return corners_;
  }

  /// One past the greatest index, and the place of that index.
  struct Greatest {
    std::uint32_t index_end = 0;
    std::size_t place = 0;
  };
  [[nodiscard]] const Greatest& greatest() const { return greatest_; }
  [[nodiscard]] bool has_range_error() const { return greatest_.index_end > vertex_count(); }
  [[nodiscard]] bool is_empty() const { return mesh_.triangles.empty(); }

  /// Cuts the polygons into triangles (cut_polygon.h) and returns the mesh.
  ///
  /// Each index has to be in range. Triangles stand in the order of their polygons.
  ///
  /// The log gets three numbers: polygons of more than three corners, concave polygons, and holes.
  /// It warns of polygons that cross themselves, which stay fans, so that each corner and edge is
  /// covered. It warns of polygons that are not planar, with the greatest deviation.
  [[nodiscard]] Mesh finish(ReadingLog& log);

  [[nodiscard]] Mesh finish() {
    ReadingLog ignored({}, {});
    return finish(ignored);
  }

  /// Returns the vertices alone.
  [[nodiscard]] std::vector<Eigen::Vector3d> take_vertices() { return std::move(mesh_.vertices); }

 private:
  /// Polygons of equally many corners that follow each other, in the mesh and at equal steps in the
  /// file.
  ///
  /// Until finish() their triangles are fans, from which the corners can be recovered.
  struct PolygonRun {
    std::size_t first_triangle = 0;
    std::size_t place = 0;
    std::size_t place_step = 0;
    std::size_t count = 0;
    std::uint32_t corners = 0;
    std::uint32_t holes = 0;
  };

  /// The findings of finish() about the polygons.
  struct Account;

  void note_polygon();
  void cut_one(const PolygonRun& run, std::size_t i, Account& account);
  void replace(std::size_t first, std::size_t count,
               const std::vector<std::array<std::uint32_t, 3>>& triangles, Account& account);
  void close_gaps(const Account& account);
  void report(const Account& account, ReadingLog& log) const;
  [[nodiscard]] ParseError at(std::size_t place, const ReadingLog& log,
                              const std::string& message) const;

  Mesh mesh_;
  Place places_;
  Greatest greatest_;
  std::size_t place_ = 0;
  std::size_t corners_ = 0;
  std::size_t first_triangle_ = 0;
  std::uint32_t first_ = 0;
  std::uint32_t previous_ = 0;
  std::uint32_t holes_ = 0;
  std::vector<std::uint32_t> hole_begins_;  ///< Holes of all polygons, as indices into the corners
                                            ///< of each.
  std::vector<PolygonRun> runs_;
};

}  // namespace firstcontact::detail
