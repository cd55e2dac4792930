#include <firstcontact/query/detail/close_pairs_of_few.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cstddef>
#include <cstdint>

#include <Eigen/Geometry>

#include <firstcontact/geometry/feature_table.h>
#include <firstcontact/narrowphase/closest_features.h>
#include <firstcontact/narrowphase/feature_batches.h>
#include <firstcontact/query/detail/nearest_feature_pairs.h>

namespace firstcontact::detail {
namespace {

using Eigen::AlignedBox3d;
using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr std::size_t kMost = FeatureTable::kMost;
static_assert(FeatureLanes::kCapacity >= kMost &&
              FaceBatch::kCapacity >= FeatureTable::kMostTriangles);

/// The sides of a box, as six bits, that a point is beyond.
unsigned sides_beyond(const Vector3d& p, const AlignedBox3d& box) {
  unsigned sides = 0;
  for (int k = 0; k < 3; ++k) {
    sides |= (p[k] < box.min()[k] ? 1u : 0u) << (2 * k);
    sides |= (p[k] > box.max()[k] ? 2u : 0u) << (2 * k);
  }
  return sides;
}

/// A body at an instant, seen from the centre of A's hierarchy, with its features that may be near
/// the other body.
struct PlacedFeatures {
  /// @param place  gives the place of a vertex
  template <class Place>
  PlacedFeatures(const Shape& shape, double t, const Matrix3d& R, const Vector3d& centre,
                 const Place& place)
      : table(shape.feature_table()), R_WS(R), p_AS(centre) {
    const Hierarchy& hierarchy = shape.hierarchy();
    for (std::uint32_t v = 0; v < hierarchy.vertices.size(); ++v) {
      const Vector3d own = hierarchy.vertex(v, t);
      box.extend(own);
      corners.add(place(own));
    }
  }

  [[nodiscard]] Triangle triangle(std::size_t number) const {
    const auto& vertices = table.faces[number].vertices;
    return {corners[vertices[0]], corners[vertices[1]], corners[vertices[2]]};
  }

  /// Leaves out edges and faces that are all beyond one side of the other body's box, by more than
  /// `apart` [m].
  void find_near(const PlacedFeatures& other, double apart) {
    const Vector3d slack = Vector3d::Constant(apart);
    const AlignedBox3d around(other.box.min() - slack, other.box.max() + slack);
    std::array<unsigned, kMost> sides;
    for (std::size_t v = 0; v < corners.count; ++v) {
      sides[v] = sides_beyond(other.R_WS.transpose() * (corners[v] - other.p_AS), around);
    }
    for (const FeatureTable::Edge& edge : table.edges) {
      if ((sides[edge.vertices[0]] & sides[edge.vertices[1]]) == 0) {
        near_edges[edges.count()] = &edge;
        edges.add(corners[edge.vertices[0]], corners[edge.vertices[1]]);
      }
    }
    prepare(edges);
    for (std::size_t face = 0; face < table.faces.size(); ++face) {
      const auto& v = table.faces[face].vertices;
      if ((sides[v[0]] & sides[v[1]] & sides[v[2]]) == 0) {
        near_faces[faces.count()] = static_cast<std::uint8_t>(face);
        faces.add(triangle(face));
      }
    }
    prepare(faces);
  }

  CornerBatch corners;
  EdgeBatch edges;  // Edges that may be near.
  FaceBatch faces;  // Faces that may be near.
  std::array<const FeatureTable::Edge*, kMost> near_edges;
  const FeatureTable& table;
  const Matrix3d& R_WS;
  Vector3d p_AS;
  AlignedBox3d box;  // Body axes, from the centre of its hierarchy.
  std::array<std::uint8_t, FeatureTable::kMostTriangles> near_faces;
};

/// The question about two bodies.
struct Question {
  double band;  // [m]
  double size;  // [m]  No coordinate is greater.
};

/// The number of the feature of an edge in whose interior the point at s lies.
std::size_t number_at(const FeatureTable::Edge& edge, double s) {
  if (s == 0.0) {
    return edge.ends[0];
  }
  return s == 1.0 ? edge.ends[1] : edge.number;
}

void add_edges(const PlacedFeatures& A, const PlacedFeatures& B, const Question& question,
               NearestFeaturePairs& nearest) {
  EdgeDistances distances;
  for (std::size_t i = 0; i < A.edges.count(); ++i) {
    edge_distances(A.edges, i, B.edges, question.band, question.size, distances);
    const FeatureTable::Edge& a = *A.near_edges[i];
    for (std::uint64_t left = distances.within; left != 0; left &= left - 1) {
      const auto j = static_cast<std::size_t>(std::countr_zero(left));
      const FeatureTable::Edge& b = *B.near_edges[j];
      const double s = distances.s[j];
      const double t = distances.t[j];
      nearest.add({number_at(a, s), number_at(b, t), a.triangle, b.triangle}, distances.distance[j],
                  [&] {
                    return ClosestFeatures{distances.distance[j],
                                           point_on_edge(A.edges.from[i], A.edges.to[i], s),
                                           point_on_edge(B.edges.from[j], B.edges.to[j], t),
                                           edge_or_end(a.k, s), edge_or_end(b.k, t)};
                  });
    }
  }
}

/// Corners and edges of S against the faces of T.
class OverFaces {
 public:
  /// @param swapped  S is B
  OverFaces(const PlacedFeatures& S, const PlacedFeatures& T, bool swapped,
            const Question& question, NearestFeaturePairs& nearest)
      : S_(S), T_(T), swapped_(swapped), question_(question), nearest_(nearest) {
    corner_feet(S.corners, T.faces, question.band, question.size, feet_);
  }

  /// Adds all in the order in which triangles have them: a corner, then the edge that begins there.
  void add_all() {
    const auto place = [](const auto& feature) { return 3 * feature.triangle + feature.k; };
    auto corner = S_.table.corners.begin();
    for (std::size_t i = 0; i < S_.edges.count(); ++i) {
      const FeatureTable::Edge& edge = *S_.near_edges[i];
      for (; corner != S_.table.corners.end() && place(*corner) <= place(edge); ++corner) {
        add_corner(*corner);
      }
      add_edge(edge);
    }
    for (; corner != S_.table.corners.end(); ++corner) {
      add_corner(*corner);
    }
  }

 private:
  void add_corner(const FeatureTable::Corner& corner) {
    const CornerFeet& feet = feet_[corner.vertex];
    for (std::uint32_t left = feet.within; left != 0; left &= left - 1) {
      const auto face = static_cast<std::size_t>(std::countr_zero(left));
      add(corner.number, corner.triangle, face,
          corner_over_face(S_.triangle(corner.triangle), corner.k, T_.faces[face], feet[face],
                           swapped_));
    }
  }

  void add_edge(const FeatureTable::Edge& edge) {
    const CornerFeet& begin = feet_[edge.vertices[0]];
    const CornerFeet& end = feet_[edge.vertices[1]];
    for (std::uint32_t left = begin.above ^ end.above; left != 0; left &= left - 1) {
      const auto face = static_cast<std::size_t>(std::countr_zero(left));
      const auto through = edge_through_face(S_.triangle(edge.triangle), edge.k, T_.faces[face],
                                             begin[face], end[face], swapped_);
      if (through) {
        const TriangleFeature& feature = swapped_ ? through->feature_B : through->feature_A;
        const bool is_end = feature.type == TriangleFeature::Type::vertex;
        add(is_end ? edge.ends[feature.index == edge.k ? 0 : 1] : edge.number, edge.triangle, face,
            *through);
      }
    }
  }

  void add(std::size_t number, std::size_t triangle, std::size_t face,
           const ClosestFeatures& closest) {
    if (!(closest.distance <= question_.band)) {
      return;
    }
    const std::size_t of_T = T_.near_faces[face];
    const std::size_t face_number = T_.table.faces[of_T].number;
    const FoundFeatures found = swapped_ ? FoundFeatures{face_number, number, of_T, triangle}
                                         : FoundFeatures{number, face_number, triangle, of_T};
    nearest_.add(found, closest.distance, [&] { return closest; });
  }

  const PlacedFeatures& S_;
  const PlacedFeatures& T_;
  bool swapped_;
  const Question& question_;
  NearestFeaturePairs& nearest_;
  std::array<CornerFeet, FeatureLanes::kCapacity> feet_;  // For each vertex of S.
};

}  // namespace

bool are_few(const ContactFrame& frame) {
  const MovingPair& pair = frame.pair;
  return std::max(pair.A().triangles.size(), pair.B().triangles.size()) <=
             FeatureTable::kMostTriangles &&
         !frame.A.feature_table().has_needles && !frame.B.feature_table().has_needles;
}

// Derivation, u = 2^-53: R, as it is stored, is orthogonal up to 44 u and the rotation's error. So
// coordinates along a body's axes are those of its placed corners, up to as much of its radius.
// Rounding adds 12 u of R_A + R_B + |p_AB|, and the axes are not longer than 1 + 22 u. All this is
// less than 2 gap_error(), which has 128 u. So features that are left out are placed farther apart
// than the band, and would not be listed.
void find_close_of_few(const ContactFrame& frame, const RelativeState& state, double band,
                       WorkspaceData& workspace) {
  const MovingPair& pair = frame.pair;
  assert(are_few(frame));
  const double apart = band + 2.0 * pair.gap_error(state);
  // Places corners as MovingPair::place() does, to the last bit.
  const auto place_A = [&](const Vector3d& own) -> Vector3d { return state.R_WA * own; };
  const auto place_B = [&](const Vector3d& own) -> Vector3d {
    return state.p_AB + state.R_WB * own;
  };
  PlacedFeatures A(frame.A, state.t, state.R_WA, Vector3d::Zero(), place_A);
  PlacedFeatures B(frame.B, state.t, state.R_WB, state.p_AB, place_B);
  A.find_near(B, apart);
  B.find_near(A, apart);
  workspace.close_pairs.clear();
  workspace.close_keys.clear();
  NearestFeaturePairs nearest(frame, A.table, B.table, workspace.close_pairs);
  const Question question{band, pair.A().radius + pair.B().radius + state.p_AB.norm()};
  add_edges(A, B, question, nearest);
  OverFaces(A, B, false, question, nearest).add_all();
  OverFaces(B, A, true, question, nearest).add_all();
  nearest.list(workspace.close_keys);
}

}  // namespace firstcontact::detail
