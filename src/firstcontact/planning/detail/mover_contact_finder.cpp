#include <firstcontact/planning/detail/mover_contact_finder.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include <Eigen/Geometry>

#include <firstcontact/geometry/hierarchy.h>
#include <firstcontact/geometry/mesh.h>
#include <firstcontact/geometry/shape.h>
#include <firstcontact/query/close_features.h>
#include <firstcontact/robot_check/robot_scene.h>

namespace firstcontact::detail {
namespace {

constexpr std::size_t kMostContacts = 48;
constexpr std::size_t kTriangles = 600;  // Most triangles of the mover that are used.
constexpr double kAlike = 0.05;          // [-]  Contacts whose rows differ by less are one.
constexpr double kBeside = 0.02;  // [-]  Part of the reach of the mover; contacts so near are one.
constexpr double kDifference = 1e-6;  // [rad or m]  Step of a coordinate for its Jacobian.

Pose pose_of_geometry(const Pose& X_WM, const Pose& X_MG) {
  const Eigen::Quaterniond R_WM = X_WM.rotation.normalized();
  return {X_WM.position + R_WM * X_MG.position, R_WM * X_MG.rotation.normalized()};
}

/// A shape of some triangles of another one, spread over it, where that has very many.
Shape thinned(const Shape& shape) {
  const Mesh& mesh = shape.mesh();
  if (mesh.triangles.size() <= 2 * kTriangles) {
    return shape;
  }
  Mesh few;
  for (std::size_t k = 0; k < kTriangles; ++k) {
    const auto& triangle = mesh.triangles[k * mesh.triangles.size() / kTriangles];
    const auto first = static_cast<std::uint32_t>(few.vertices.size());
    for (const std::uint32_t vertex : triangle) {
      few.vertices.push_back(mesh.vertices[vertex]);
    }
    few.triangles.push_back({first, first + 1, first + 2});
  }
  return Shape(std::move(few), shape.radius());
}

/// [m]  The gap of the balls around two shapes.
double gap_of_balls(const PlacedShape& A, const PlacedShape& B) {
  const auto centre = [](const PlacedShape& S) -> Eigen::Vector3d {
    return S.pose().position + S.pose().rotation.normalized() * S.shape().hierarchy().centre;
  };
  return (centre(A) - centre(B)).norm() - A.shape().hierarchy().radius - A.shape().radius() -
         B.shape().hierarchy().radius - B.shape().radius();
}

/// The normal and the place of a contact as comparable numbers.
Eigen::Matrix<double, 6, 1> row_of(const NearContact& contact, const Eigen::Vector3d& centre,
                                   double reach) {
  Eigen::Matrix<double, 6, 1> row;
  row << contact.n_AB_W, (contact.p_WP - centre).cross(contact.n_AB_W) / reach;
  return row;
}

/// Sorts contacts, and keeps the nearest of those that constrain alike.
void keep_different(std::vector<NearContact>& contacts, const Eigen::Vector3d& centre,
                    double reach) {
  std::stable_sort(contacts.begin(), contacts.end(),
                   [](const NearContact& x, const NearContact& y) { return x.gap < y.gap; });
  std::vector<NearContact> kept;
  std::vector<Eigen::Matrix<double, 6, 1>> rows;
  for (const NearContact& contact : contacts) {
    const Eigen::Matrix<double, 6, 1> row = row_of(contact, centre, reach);
    const bool is_new = std::none_of(rows.begin(), rows.end(), [&](const auto& other) {
      return (other - row).squaredNorm() < kAlike * kAlike;
    });
    if (is_new) {
      kept.push_back(contact);
      rows.push_back(row);
      if (kept.size() == kMostContacts) {
        break;
      }
    }
  }
  contacts = std::move(kept);
}

}  // namespace

MoverContactFinder::MoverContactFinder(const PlanScene& scene, const TangentSpace& tangents,
                                       double kept)
    : plan_(scene), tangents_(tangents) {
  const RobotScene& all = scene.scene;
  moves_.resize(all.size());
  for (std::size_t member = 0; member < all.size(); ++member) {
    const auto link = all.robot_link(member);
    moves_[member] = link && scene.mover(link->robot);
  }
  for (const Attachment& attachment : all.attachments()) {
    moves_[attachment.body] = moves_[attachment.body] || moves_[attachment.link];
  }
  for (std::size_t b = 0; b < all.size(); ++b) {
    for (std::size_t a = 0; a < b; ++a) {
      const std::optional<double> margin = all.margin({a, b});
      if ((moves_[a] || moves_[b]) && margin) {
        pairs_.push_back({{a, b}, *margin + kept});
      }
    }
  }
  resting_.resize(all.size());
  moved_.resize(all.size());
  for (std::size_t member = 0; member < all.size(); ++member) {
    for (const MemberGeometry& geometry : all.geometries(member)) {
      if (moves_[member]) {
        moved_[member].push_back(thinned(geometry.shape));
      } else {
        resting_[member].emplace_back(geometry.shape,
                                      pose_of_geometry(all.pose(member, 0.0), geometry.X_MG));
      }
    }
  }
  if (!scene.space.is_body()) {
    posed_.emplace(all);
  }
}

std::vector<MovedMember> MoverContactFinder::members_at(const Configuration& q) {
  std::vector<MovedMember> members(moves_.size());
  if (plan_.space.is_body()) {
    members[plan_.scene.first_member(plan_.robots.front())] = tangents_.moved_body(q);
    return members;
  }
  plan_.set_motions(*posed_, q, q);
  for (std::size_t member = 0; member < members.size(); ++member) {
    if (moves_[member]) {
      members[member].X_WM = posed_->pose(member, 0.0);
      members[member].p_WR = members[member].X_WM.position;
      members[member].J.setZero(6, tangents_.size());
    }
  }
  for (Eigen::Index k = 0; k < tangents_.size(); ++k) {
    const Configuration beside = tangents_.beside(q, k, kDifference);
    plan_.set_motions(*posed_, beside, beside);
    for (std::size_t member = 0; member < members.size(); ++member) {
      if (!moves_[member]) {
        continue;
      }
      const Pose there = posed_->pose(member, 0.0);
      const Eigen::AngleAxisd turn(there.rotation.normalized() *
                                   members[member].X_WM.rotation.normalized().conjugate());
      members[member].J.col(k).head<3>() = (there.position - members[member].p_WR) / kDifference;
      members[member].J.col(k).tail<3>() = turn.axis() * turn.angle() / kDifference;
    }
  }
  return members;
}

const PlacedShape& MoverContactFinder::placed(std::size_t member, std::size_t geometry,
                                              const MovedMember& at,
                                              std::optional<PlacedShape>& moved) const {
  if (!moves_[member]) {
    return resting_[member][geometry];
  }
  const MemberGeometry& of = plan_.scene.geometries(member)[geometry];
  return moved.emplace(moved_[member][geometry], pose_of_geometry(at.X_WM, of.X_MG));
}

void MoverContactFinder::take(const Pair& pair, const ContactsAt& at, double band,
                              std::vector<NearContact>& found) {
  const auto [a, b] = pair.members;
  for (std::size_t i = 0; i < plan_.scene.geometries(a).size(); ++i) {
    for (std::size_t k = 0; k < plan_.scene.geometries(b).size(); ++k) {
      std::optional<PlacedShape> moved_A;
      std::optional<PlacedShape> moved_B;
      const PlacedShape& A = placed(a, i, at.members[a], moved_A);
      const PlacedShape& B = placed(b, k, at.members[b], moved_B);
      const double reach = band + pair.margin;
      if (gap_of_balls(A, B) > reach) {
        continue;
      }
      close_features(A, B, reach, workspace_, contacts_, kBeside * tangents_.reach());
      for (const Contact& contact : contacts_) {
        if (contact.n_AB_W) {
          found.push_back({pair.members, 0.5 * (contact.p_WA + contact.p_WB), *contact.n_AB_W,
                           contact.distance - pair.margin});
        }
      }
    }
  }
}

ContactsAt MoverContactFinder::near(const Configuration& q, double band) {
  ContactsAt at{members_at(q), {}};
  for (const Pair& pair : pairs_) {
    take(pair, at, band, at.contacts);
  }
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  for (std::size_t member = 0; member < moves_.size(); ++member) {
    if (moves_[member]) {
      centre = at.members[member].p_WR;
    }
  }
  keep_different(at.contacts, centre, tangents_.reach());
  return at;
}

}  // namespace firstcontact::detail
