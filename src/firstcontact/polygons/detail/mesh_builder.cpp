#include <firstcontact/polygons/detail/mesh_builder.h>

#include <cassert>
#include <cstdio>
#include <span>

#include <Eigen/Geometry>

#include <firstcontact/polygons/detail/cut_polygon.h>

namespace firstcontact::detail {
namespace {

using Triangle = std::array<std::uint32_t, 3>;

/// [-]  Polygons thicker than this fraction of the mesh's diagonal are not planar.
///
/// Decimals of six places stay below it, on a body of some tenths of a metre.
constexpr double kPlanar = 1e-5;

double diagonal(const std::vector<Eigen::Vector3d>& vertices) {
  Eigen::AlignedBox3d bounds;
  for (const Eigen::Vector3d& p : vertices) {
    bounds.extend(p);
  }
  return bounds.isEmpty() ? 0.0 : bounds.diagonal().norm();
}

/// Recovers the corners from which a fan was made.
void corners_of_fan(std::span<const Triangle> fan, std::size_t count,
                    std::vector<std::uint32_t>& corners) {
  corners.assign({fan[0][0], fan[0][1]});
  for (std::size_t k = 0; k + 2 < count; ++k) {
    corners.push_back(fan[k][2]);
  }
}

std::vector<Triangle> fans_of(const PolygonRings& polygon) {
  std::vector<Triangle> triangles;
  std::size_t begin = 0;
  for (std::size_t ring = 0; ring <= polygon.hole_begins.size(); ++ring) {
    const std::size_t end =
        ring == polygon.hole_begins.size() ? polygon.corners.size() : polygon.hole_begins[ring];
    for (std::size_t i = begin + 1; i + 1 < end; ++i) {
      triangles.push_back({polygon.corners[begin], polygon.corners[i], polygon.corners[i + 1]});
    }
    begin = end;
  }
  return triangles;
}

std::string in_digits(double length) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.3g", length);
  return text.data();
}

std::string counted(std::size_t count, const char* what) {
  return std::to_string(count) + " " + what + (count == 1 ? "" : "s");
}

}  // namespace

struct MeshBuilder::Account {
  double planar = 0.0;  ///< [m]  Greatest thickness of a planar polygon.
  std::size_t polygons = 0;
  std::size_t concave = 0;
  std::size_t holes = 0;
  std::size_t crossing = 0;
  std::size_t first_crossing = 0;  ///< Place of the first polygon that crosses itself.
  std::size_t not_planar = 0;
  double deviation = 0.0;                          ///< [m]  The greatest deviation from a plane.
  std::size_t deviating = 0;                       ///< Place of the polygon with it.
  std::size_t hole_begin = 0;                      ///< Index in hole_begins_ for the next polygon.
  std::vector<Triangle> extra;                     ///< Triangles for which a polygon had no room.
  std::vector<std::array<std::size_t, 2>> unused;  ///< First triangle and number, ascending.
  std::vector<std::uint32_t> corners;              ///< Corners of the present polygon.
};

void MeshBuilder::note_polygon() {
  // A hole needs two triangles more than a fan of all corners has.
  mesh_.triangles.resize(mesh_.triangles.size() + 2 * std::size_t{holes_},
                         Triangle{first_, first_, first_});
  if (!runs_.empty() && holes_ == 0) {
    PolygonRun& run = runs_.back();
    const std::size_t step = place_ - run.place;
    if (run.holes == 0 && run.corners == corners_ &&
        first_triangle_ == run.first_triangle + run.count * (corners_ - 2) &&
        (run.count == 1 || step == run.count * run.place_step)) {
      run.place_step = run.count == 1 ? step : run.place_step;
      ++run.count;
      return;
    }
  }
  runs_.push_back({.first_triangle = first_triangle_,
                   .place = place_,
                   .place_step = 0,
                   .count = 1,
                   .corners = static_cast<std::uint32_t>(corners_),
                   .holes = holes_});
}

void MeshBuilder::replace(std::size_t first, std::size_t count,
                          const std::vector<Triangle>& triangles, Account& account) {
  const std::size_t used = std::min(count, triangles.size());
  std::copy_n(triangles.begin(), used,
              mesh_.triangles.begin() + static_cast<std::ptrdiff_t>(first));
  account.extra.insert(account.extra.end(), triangles.begin() + static_cast<std::ptrdiff_t>(used),
                       triangles.end());
  if (used < count) {
    account.unused.push_back({first + used, count - used});
  }
}

void MeshBuilder::cut_one(const PolygonRun& run, std::size_t i, Account& account) {
  const std::size_t slots = run.corners - 2 + 2 * std::size_t{run.holes};
  const std::size_t first = run.first_triangle + i * slots;
  corners_of_fan({mesh_.triangles.data() + first, slots}, run.corners, account.corners);
  const PolygonRings polygon{account.corners,
                             {hole_begins_.data() + account.hole_begin, run.holes}};
  account.hole_begin += run.holes;
  const std::size_t place = run.place + i * run.place_step;
  const std::span<const std::uint32_t> outer(
      account.corners.data(), run.holes > 0 ? polygon.hole_begins.front() : run.corners);
  const Eigen::Vector3d normal = newell_normal(mesh_.vertices, outer);
  const double deviation = deviation_from_plane(mesh_.vertices, account.corners, normal);
  account.not_planar += deviation > account.planar ? 1 : 0;
  if (deviation > account.deviation) {
    account.deviation = deviation;
    account.deviating = place;
  }
  if (run.holes == 0 && is_plainly_convex(mesh_.vertices, account.corners, normal)) {
    return;
  }
  const PolygonCut cut = cut_polygon(mesh_.vertices, polygon);
  account.concave += cut.is_concave ? 1 : 0;
  if (cut.crosses && account.crossing++ == 0) {
    account.first_crossing = place;
  }
  if (!cut.is_fan && !(cut.crosses && run.holes == 0)) {
    replace(first, slots, cut.crosses ? fans_of(polygon) : cut.triangles, account);
  }
}

void MeshBuilder::close_gaps(const Account& account) {
  auto& triangles = mesh_.triangles;
  if (!account.unused.empty()) {
    const auto at = [&](std::size_t k) {
      return triangles.begin() + static_cast<std::ptrdiff_t>(k);
    };
    auto end = at(account.unused.front()[0]);
    for (std::size_t k = 0; k < account.unused.size(); ++k) {
      const std::size_t next =
          k + 1 < account.unused.size() ? account.unused[k + 1][0] : triangles.size();
      end = std::move(at(account.unused[k][0] + account.unused[k][1]), at(next), end);
    }
    triangles.erase(end, triangles.end());
  }
  triangles.insert(triangles.end(), account.extra.begin(), account.extra.end());
}

ParseError MeshBuilder::at(std::size_t place, const ReadingLog& log,
                           const std::string& message) const {
  return places_ == Place::line ? ParseError(log.path(), place, message)
                                : ParseError::at_byte(log.path(), place, message);
}

void MeshBuilder::report(const Account& account, ReadingLog& log) const {
  if (account.polygons > 0) {
    log.add_content("polygons of more than three corners", account.polygons);
  }
  if (account.concave > 0) {
    log.add_content("concave polygons", account.concave);
  }
  if (account.holes > 0) {
    log.add_content("holes", account.holes);
  }
  if (account.crossing > 0) {
    log.warn(at(account.first_crossing, log,
                "a polygon crosses itself or folds over, so that nothing says what it covers: it "
                "is taken as a fan about its first corner, which may cover more; " +
                    counted(account.crossing, "such polygon") + " in all"));
  }
  if (account.not_planar > 0) {
    log.warn(at(account.deviating, log,
                std::to_string(account.not_planar) + " of " + counted(account.polygons, "polygon") +
                    " of more than three corners not planar within " + in_digits(account.planar) +
                    " m: the surface depends on how they are cut; "
                    "the greatest deviation, " +
                    in_digits(account.deviation) + " m, is here"));
  }
}

Mesh MeshBuilder::finish(ReadingLog& log) {
  assert(!has_range_error());
  Account account;
  if (!runs_.empty()) {
    account.planar = kPlanar * diagonal(mesh_.vertices);
    account.holes = hole_begins_.size();
    for (const PolygonRun& run : runs_) {
      account.polygons += run.count;
      for (std::size_t i = 0; i < run.count; ++i) {
        cut_one(run, i, account);
      }
    }
    close_gaps(account);
    report(account, log);
  }
  mesh_.vertices.shrink_to_fit();
  mesh_.triangles.shrink_to_fit();
  return std::move(mesh_);
}

}  // namespace firstcontact::detail
