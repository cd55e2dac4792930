#include <firstcontact/articulated/link_contact.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <optional>
#include <queue>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include <firstcontact/articulated/detail/link_pair.h>
#include <firstcontact/math/float_environment.h>
#include <firstcontact/query/distance.h>

namespace firstcontact {
namespace {

using detail::LinkBox;
using detail::LinkPair;
using detail::Separation;

/// [-]  Of the rest of a window: links need not be placed anew for a time so little later.
constexpr double kSameTime = 0.03;

/// Two boxes that may meet from `t` on, and not before.
struct Entry {
  double t = 0.0;
  int depth = 0;
  LinkBox a;
  LinkBox b;
};

/// Least time first; of the same time the deepest.
struct Later {
  bool operator()(const Entry& x, const Entry& y) const {
    return x.t != y.t ? x.t > y.t : x.depth < y.depth;
  }
};

/// One search over one window of time after another.
class LinkSearch {
 public:
  LinkSearch(const MovingLink& A, const MovingLink& B, const LinkContactOptions& options)
      : A_(A.shape.hierarchy()),
        B_(B.shape.hierarchy()),
        motion_A_(A.X_FS.then(centre_of(A_))),
        motion_B_(B.X_FS.then(centre_of(B_))),
        options_(options),
        threshold_(options.margin + A.shape.radius() + B.shape.radius()) {
    result_.tolerance_used = options.tolerance;
    result_.enclosure_error = A.shape.enclosure_error() + B.shape.enclosure_error();
  }

  LinkContactResult run() {
    const auto pieces_A = motion_A_.pieces();
    const auto pieces_B = motion_B_.pieces();
    std::size_t a = 0;
    std::size_t b = 0;
    double t = 0.0;
    while (a < pieces_A.size() && b < pieces_B.size()) {
      const double end = std::min(pieces_A[a].t_end(), pieces_B[b].t_end());
      if (!search_piece(pieces_A[a], pieces_B[b], t, end)) {
        return result_;
      }
      t = end;
      a += pieces_A[a].t_end() == end ? 1 : 0;
      b += pieces_B[b].t_end() == end ? 1 : 0;
    }
    result_.verdict = Verdict::free;
    result_.t = 1.0;
    return result_;
  }

 private:
  static PreciseTransform centre_of(const Hierarchy& hierarchy) {
    PreciseTransform X;
    X.position = DoubleDoubleVector3(hierarchy.centre);
    return X;
  }

  /// Whether [begin, end] is free; else the result says what was found.
  bool search_piece(const LinkPath& A, const LinkPath& B, double begin, double end) {
    path_A_ = &A;
    path_B_ = &B;
    double t = begin;
    while (true) {
      origin_ = DoubleDoubleVector3(A.pose(t).p_OL);
      end_ = end;
      place(t, end);
      const double apart = pair_->balls_apart(threshold_);
      if (is_beyond(t, apart)) {
        return true;
      }
      const double length = window_length();
      const double later = t + apart * (1.0 - 0x1p-40);
      if (apart >= length && later > t && later < end) {  // No need to look at the boxes yet.
        t = later;
        continue;
      }
      const double window_end = std::min(t + length, end);
      if (!search_window(t, window_end)) {
        return false;
      }
      if (window_end == end) {
        return true;
      }
      t = window_end;
    }
  }

  /// V T bounds the way that a point goes, J T^3 / 6 what the second order misses of it.
  [[nodiscard]] double window_length() const {
    double length = end_ - at_A_.t();
    for (const LinkWindow* window : {&at_A_, &at_B_}) {
      const CoordinateSegment::Bounds& bounds = window->bounds();
      if (bounds.jerk > 0.0) {
        length = std::min(length, std::sqrt(0.5 * bounds.rate / bounds.jerk));
      }
    }
    // At least a thousandth of what is left: windows end.
    return std::max(length, 1e-3 * (end_ - at_A_.t()));
  }

  void place(double t, double end) {
    const auto whole = [](const Hierarchy& hierarchy) {
      return LinkPart{.radius = hierarchy.radius * (1.0 + 0x1p-44)};
    };
    at_A_ = path_A_->window(t, t, end, whole(A_), scratch_, origin_);
    at_B_ = path_B_->window(t, t, end, whole(B_), scratch_, origin_);
    pair_.emplace(A_, B_, at_A_, at_B_);
    // A quarter of the tolerance covers the error of a distance, of a gap, and room between.
    result_.tolerance_used = std::max(result_.tolerance_used, 8.0 * pair_->gap_error());
  }

  bool search_window(double begin, double end) {
    queue_ = {};
    end_ = end;
    place(begin, end);
    push_children(begin, 0, {}, {}, true, true);
    while (!queue_.empty()) {
      const Entry entry = queue_.top();
      queue_.pop();
      if (result_.steps >= options_.steps) {
        return give_up(UndecidedReason::work, entry.t);
      }
      const bool leaf_a = A_.nodes[entry.a.node].is_leaf(entry.a.slot);
      const bool leaf_b = B_.nodes[entry.b.node].is_leaf(entry.b.slot);
      if (leaf_a && leaf_b) {
        if (!advance(entry)) {
          return false;
        }
      } else {
        open(entry, leaf_a, leaf_b);
      }
    }
    return true;
  }

  [[nodiscard]] bool is_beyond(double t, double tau) const {
    return tau > (end_ - t) * (1.0 + 0x1p-40) + 0x1p-100;
  }

  void push_if_close(Entry entry) {
    ++result_.steps;
    const double t = at_A_.t();
    assert(t <= entry.t);  // A bound says nothing of the time before it.
    const Separation separation = pair_->boxes(entry.a, entry.b, threshold_);
    if (!is_beyond(t, separation.time)) {
      entry.t = std::clamp(t + separation.time * (1.0 - 0x1p-40), entry.t, end_);
      queue_.push(entry);
    }
  }

  void place_at(double t) {
    if (t != at_A_.t()) {
      place(t, end_);
    }
  }

  /// Far pairs are bounded again from where they are now; near ones opened. Bounds that start a
  /// little earlier, where the links have been placed already, hold too: they lose what is of
  /// second order in time.
  void open(const Entry& entry, bool leaf_a, bool leaf_b) {
    const double later = entry.t - at_A_.t();
    if (!(later >= 0.0 && later <= kSameTime * (end_ - at_A_.t()))) {
      place(entry.t, end_);
    }
    const Separation separation = pair_->boxes(entry.a, entry.b, threshold_);
    const double radius_a = LinkPair::radius(A_, entry.a);
    const double radius_b = LinkPair::radius(B_, entry.b);
    if (separation.gap > 0.5 * (radius_a + radius_b)) {
      place_at(entry.t);
      push_if_close(entry);
      return;
    }
    const bool open_a = !leaf_a && (leaf_b || radius_a >= radius_b);
    push_children(entry.t, entry.depth + 1, entry.a, entry.b, open_a, !open_a);
  }

  /// All boxes of an opened side: of its child node, or of the root at depth 0.
  static std::vector<LinkBox> boxes(const Hierarchy& hierarchy, LinkBox box, bool opened,
                                    bool root) {
    if (!opened) {
      return {box};
    }
    const std::uint32_t node = root ? 0 : hierarchy.nodes[box.node].child_node(box.slot);
    std::vector<LinkBox> all;
    for (int slot = 0; slot < HierarchyNode::kWidth; ++slot) {
      if ((hierarchy.nodes[node].used() >> slot & 1u) != 0) {
        all.push_back({node, slot});
      }
    }
    return all;
  }

  void push_children(double t, int depth, LinkBox a, LinkBox b, bool open_a, bool open_b) {
    for (const LinkBox& child_a : boxes(A_, a, open_a, depth == 0)) {
      for (const LinkBox& child_b : boxes(B_, b, open_b, depth == 0)) {
        push_if_close({t, depth, child_a, child_b});
      }
    }
  }

  /// Advances two triangles until they touch, pass the window's end, or wait behind another pair.
  bool advance(Entry entry) {
    const std::uint32_t a = A_.nodes[entry.a.node].child_triangle(entry.a.slot);
    const std::uint32_t b = B_.nodes[entry.b.node].child_triangle(entry.b.slot);
    place_at(entry.t);
    while (true) {
      ++result_.steps;
      const ClosestFeatures closest = pair_->distance(a, b);
      if (closest.distance + pair_->gap_error() <= threshold_ + result_.tolerance_used) {
        found(entry.t, a, b, closest);
        return false;
      }
      const double tau = pair_->triangles_apart(a, b, closest, threshold_);
      if (is_beyond(entry.t, tau)) {
        return true;
      }
      const double next = std::min(entry.t + tau * (1.0 - 0x1p-40), end_);
      if (!(next > entry.t)) {
        return give_up(UndecidedReason::precision, entry.t);
      }
      entry.t = next;
      if (result_.steps >= options_.steps) {
        return give_up(UndecidedReason::work,
                       queue_.empty() ? entry.t : std::min(entry.t, queue_.top().t));
      }
      if (!queue_.empty() && queue_.top().t < entry.t) {
        queue_.push(entry);
        return true;
      }
      place(entry.t, end_);
    }
  }

  void found(double t, std::uint32_t a, std::uint32_t b, const ClosestFeatures& closest) {
    result_.verdict = t == 0.0 ? Verdict::contact_at_start : Verdict::contact;
    result_.t = t;
    result_.triangles = {A_.triangle_index[a], B_.triangle_index[b]};
    result_.p_FA = origin_.value() + closest.p_A;
    result_.p_FB = origin_.value() + closest.p_B;
    result_.distance = closest.distance - (threshold_ - options_.margin);
  }

  bool give_up(UndecidedReason reason, double t) {
    result_.verdict = Verdict::undecided;
    result_.reason = reason;
    result_.t = t;
    return false;
  }

  const Hierarchy& A_;
  const Hierarchy& B_;
  LinkMotion motion_A_;
  LinkMotion motion_B_;
  const LinkContactOptions& options_;
  double threshold_;
  double end_ = 1.0;
  const LinkPath* path_A_ = nullptr;
  const LinkPath* path_B_ = nullptr;
  DoubleDoubleVector3 origin_;
  LinkWindow at_A_;
  LinkWindow at_B_;
  std::optional<LinkPair> pair_;
  LinkScratch scratch_;
  std::priority_queue<Entry, std::vector<Entry>, Later> queue_;
  LinkContactResult result_;
};

void require(bool condition, const char* message) {
  if (!condition) {
    throw std::invalid_argument(message);
  }
}

Motion resting_at_start(const MovingLink& link, const DoubleDoubleVector3& origin) {
  const LinkPose pose = link.X_FS.at(0.0).pose(0.0, origin);
  return Motion::fixed({pose.p_OL, Eigen::Quaterniond(pose.R_FL)});
}

/// Whether balls around the shapes, a little larger than need be, overlap at t = 0.
bool balls_meet_at_start(const MovingLink& A, const MovingLink& B,
                         const DoubleDoubleVector3& origin) {
  constexpr double kRoom = 1.0 + 1e-9;  // More than a pose errs by.
  const auto centre = [&](const MovingLink& link) -> Eigen::Vector3d {
    const LinkPose pose = link.X_FS.at(0.0).pose(0.0, origin);
    return pose.p_OL + pose.R_FL * link.shape.hierarchy().centre;
  };
  const auto radius = [](const Shape& shape) { return shape.hierarchy().radius + shape.radius(); };
  return !((centre(A) - centre(B)).norm() > kRoom * (radius(A.shape) + radius(B.shape)));
}

/// Whether one lies in the other's solid inside at t = 0. Where the surfaces are apart by the
/// tolerance, the rounding of the poses cannot change that.
bool is_inside_at_start(const MovingLink& A, const MovingLink& B) {
  if (!A.shape.is_solid() && !B.shape.is_solid()) {
    return false;
  }
  const DoubleDoubleVector3 origin(A.X_FS.at(0.0).pose(0.0).p_OL);
  if (!balls_meet_at_start(A, B, origin)) {
    return false;
  }
  const Motion X_WA = resting_at_start(A, origin);
  const Motion X_WB = resting_at_start(B, origin);
  Workspace workspace;
  return distance({A.shape, X_WA}, {B.shape, X_WB}, 0.0, workspace).distance == 0.0;
}

}  // namespace

LinkContactResult first_contact(const MovingLink& A, const MovingLink& B,
                                const LinkContactOptions& options) {
  require(options.margin >= 0.0 && std::isfinite(options.margin),
          "LinkContactOptions::margin must be finite and >= 0");
  require(options.tolerance > 0.0 && std::isfinite(options.tolerance),
          "LinkContactOptions::tolerance must be finite and > 0");
  require(!A.shape.hierarchy().deforms() && !B.shape.hierarchy().deforms(),
          "first_contact of links: a shape deforms; links are rigid");
  const FloatEnvironmentGuard guard;
  if (is_inside_at_start(A, B)) {
    LinkContactResult result;
    result.verdict = Verdict::contact_at_start;
    result.tolerance_used = options.tolerance;
    result.enclosure_error = A.shape.enclosure_error() + B.shape.enclosure_error();
    return result;
  }
  return LinkSearch(A, B, options).run();
}

}  // namespace firstcontact
