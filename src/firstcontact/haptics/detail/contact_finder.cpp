#include <firstcontact/haptics/detail/contact_finder.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <unordered_map>

#include <Eigen/Geometry>

#include <firstcontact/haptics/detail/constants.h>
#include <firstcontact/haptics/detail/near_patches.h>
#include <firstcontact/query/close_features.h>
#include <firstcontact/query/detail/facing_cell.h>
#include <firstcontact/query/detail/front_query.h>

namespace firstcontact::detail {
namespace {

using Eigen::Vector3d;

/// Whether both surfaces bulge towards each other at a contact. Edges that cross within a flat face
/// do not count: the gap over the face has its least value elsewhere.
bool are_outermost(const HapticMember& A, const Eigen::Quaterniond& R_AW, const HapticMember& B,
                   const Eigen::Quaterniond& R_BW, const Contact& contact) {
  const bool are_edges =
      contact.feature_A.type == FeatureType::edge && contact.feature_B.type == FeatureType::edge;
  if (are_edges && (A.neighbours->is_flat_edge(contact.feature_A) ||
                    B.neighbours->is_flat_edge(contact.feature_B))) {
    return false;
  }
  const Vector3d& n_W = *contact.n_AB_W;
  return A.neighbours->is_outermost(contact.feature_A, R_AW * n_W) &&
         B.neighbours->is_outermost(contact.feature_B, R_BW * -n_W);
}

HapticTouch touch_of(const Contact& contact, double friction) {
  HapticTouch touch;
  touch.contact.point = 0.5 * (contact.p_WA + contact.p_WB);
  touch.contact.normal = *contact.n_AB_W;
  touch.contact.gap = contact.distance;
  touch.contact.friction = friction;
  touch.feature_of_other = contact.feature_A;
  touch.feature_of_tool = contact.feature_B;
  return touch;
}

}  // namespace

/// Keeps the nearest of contacts that are beside each other and face alike.
void ContactFinder::keep_nearest_of_many(double width) {
  std::unordered_map<FacingCell, const Contact*, CellHash> nearest;
  for (const Contact* contact : chosen_) {
    const FacingCell cell = facing_cell(contact->p_WA, *contact->n_AB_W, width);
    const Contact*& kept = nearest.try_emplace(cell, contact).first->second;
    if (contact->distance < kept->distance) {
      kept = contact;
    }
  }
  chosen_.clear();
  for (const auto& [cell, contact] : nearest) {
    chosen_.push_back(contact);
  }
  std::ranges::sort(chosen_);  // Back in the order of the list.
}

void ContactFinder::choose(const HapticMember& other, const PlacedShape& other_at,
                           const HapticMember& tool, const PlacedShape& tool_at) {
  const Eigen::Quaterniond R_AW = other_at.pose().rotation.normalized().conjugate();
  const Eigen::Quaterniond R_BW = tool_at.pose().rotation.normalized().conjugate();
  chosen_.clear();
  for (const Contact& contact : contacts_) {
    if (contact.n_AB_W && are_outermost(other, R_AW, tool, R_BW, contact)) {
      chosen_.push_back(&contact);
    }
  }
  if (chosen_.empty()) {
    for (const Contact& contact : contacts_) {
      if (contact.n_AB_W) {
        chosen_.push_back(&contact);
      }
    }
  }
}

/// Finds all features within the band.
void ContactFinder::find_features(const HapticMember& other, const PlacedShape& other_at,
                                  const HapticMember& tool, const PlacedShape& tool_at,
                                  double beside, BoxFront& front) {
  const double band = kContactBand * distance_;
  const bool may_front = may_have_front(other.shape, tool.shape);
  if (may_front && other.fills_hull && tool.fills_hull) {
    const NearPatches near = near_patches(other_at, tool_at, band);
    if (near.are_apart) {
      contacts_.clear();
      return;
    }
    if (near.patches) {
      const auto& [of_other, of_tool] = *near.patches;
      close_features(PlacedShape(of_other.shape, other_at.pose()),
                     PlacedShape(of_tool.shape, tool_at.pose()), band, workspace_, contacts_,
                     beside);
      for (Contact& contact : contacts_) {
        contact.feature_A = of_other.in_whole(other.shape, contact.feature_A);
        contact.feature_B = of_tool.in_whole(tool.shape, contact.feature_B);
      }
      return;
    }
  }
  if (may_front) {
    close_features_by_front(other_at, tool_at, band, beside, front, workspace_, contacts_);
  } else {
    close_features(other_at, tool_at, band, workspace_, contacts_, beside);
  }
}

double ContactFinder::find(const HapticMember& other, const PlacedShape& other_at,
                           const HapticMember& tool, const PlacedShape& tool_at, BoxFront& front,
                           std::vector<HapticTouch>& touches) {
  const double reach = std::min(other.reach, tool.reach);
  find_features(other, other_at, tool, tool_at, kWidthOfNeighbourhood * reach, front);
  double least = std::numeric_limits<double>::infinity();
  for (const Contact& contact : contacts_) {
    least = std::min(least, contact.distance);
  }
  choose(other, other_at, tool, tool_at);
  if (chosen_.size() > kManyContacts) {
    keep_nearest_of_many(kWidthOfNeighbourhood * reach);
  }
  const double friction = std::sqrt(other.friction * tool.friction);
  const auto begin = static_cast<std::ptrdiff_t>(touches.size());
  for (const Contact* contact : chosen_) {
    const HapticTouch touch = touch_of(*contact, friction);
    const auto same = std::find_if(touches.begin() + begin, touches.end(), [&](const auto& kept) {
      return (kept.contact.point - touch.contact.point).norm() <= kOnePlace * reach &&
             kept.contact.normal.dot(touch.contact.normal) >= kOneNormal;
    });
    if (same == touches.end()) {
      touches.push_back(touch);
    } else if (touch.contact.gap < same->contact.gap) {
      *same = touch;
    }
  }
  return least;
}

}  // namespace firstcontact::detail
