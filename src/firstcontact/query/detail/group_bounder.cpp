#include <firstcontact/query/detail/group_bounder.h>

#include <array>
#include <bit>

#include <firstcontact/moving_pairs/detail/box_pairs.h>
#include <firstcontact/moving_pairs/detail/lane_times.h>
#include <firstcontact/moving_pairs/detail/moving_pair.h>

namespace firstcontact::detail {
namespace {

/// Number of pairs of triangles that came due and were then proven free for good. Beyond it the
/// next ones are expected to be so, too.
constexpr std::uint64_t kManyFreed = 256;

/// Number of pairs of boxes that are bounded again in double precision before the gain is known.
/// And the most such bounds for one pair that they free.
constexpr std::uint64_t kFewRepeated = 64;
constexpr std::uint64_t kRepeatedForOne = 4;

/// Most groups of a front with which a search begins. From the roots it takes about as many.
constexpr std::size_t kMostSeeds = 1000;

}  // namespace

void GroupBounder::bound(const Bounding& first) {
  search_.instant.place_boxes(first.t, search_.box_threshold, search_.horizon());
  const std::optional<Bounding> second = take_after(first.t);
  if (second) {
    bound_both(first, *second);
    return;
  }
  bound_one(first);
}

void GroupBounder::bound_one(const Bounding& bounding) {
  const BoxGroup& group = search_.queue.group(bounding.index);
  BoxBounds bounds;
  search_.pair.bound(search_.instant.frame(), group.node_a, group.node_b, bounds);
  take(bounding, bounds);
}

void GroupBounder::bound_both(const Bounding& first, const Bounding& second) {
  const BoxGroup& group = search_.queue.group(first.index);
  const BoxGroup& other = search_.queue.group(second.index);
  BoxBounds bounds;
  BoxBounds other_bounds;
  search_.pair.bound(search_.instant.frame(), group.node_a, group.node_b, bounds, other.node_a,
                     other.node_b, other_bounds);
  take(first, bounds);
  take(second, other_bounds);
}

bool GroupBounder::bound_front(const BoxFront& front, double t) {
  PairInstant& instant = search_.instant;
  instant.place_boxes(t, search_.box_threshold, search_.horizon());
  const FrontMotion motion(front.place(), search_.pair, instant.state(),
                           search_.horizon() - instant.t());
  const double near = (search_.box_threshold + instant.error()) * (1.0 + 0x1p-50);
  std::vector<FrontSeed>& seeds = search_.workspace.front_seeds;
  seeds.clear();
  for (std::size_t k = 0; k < front.size(); ++k) {
    if (front.least(k) > near + motion.most()) {
      continue;
    }
    if (const unsigned lanes = front.lanes_within(k, near + motion.of(front.ball(k)))) {
      seeds.push_back({static_cast<std::uint32_t>(k), lanes});
    }
  }
  if (seeds.size() > kMostSeeds) {
    return false;
  }
  bound_seeds(front, t);
  return true;
}

void GroupBounder::bound_seeds(const BoxFront& front, double t) {
  GroupQueue& queue = search_.queue;
  std::optional<Bounding> first;
  for (const FrontSeed& seed : search_.workspace.front_seeds) {
    const BoxFront::Group& group = front.group(seed.group);
    const Bounding next = queue.new_group(t, {group.node_a, 0}, {group.node_b, 0}, 0);
    queue.group(next.index).live = static_cast<std::uint16_t>(seed.lanes);
    if (first) {
      bound_both(*first, next);
      first.reset();
    } else {
      first = next;
    }
  }
  if (first) {
    bound_one(*first);
  }
}

std::optional<Bounding> GroupBounder::take_after(double t) {
  GroupQueue& queue = search_.queue;
  if (queue.empty() || queue.top().is_triangle_pair) {
    return std::nullopt;
  }
  const std::uint32_t index = queue.top().index;
  const BoxGroup& group = queue.group(index);
  const double latest = std::min(search_.horizon(), search_.instant.latest_of_second());
  if (!(t < group.due && group.due < latest)) {
    return std::nullopt;
  }
  if (GroupQueue::is_far(group)) {
    return queue.take_again(index);
  }
  const BoxPair inside = queue.next_inside(group);
  if (inside.is_triangle_pair) {
    return std::nullopt;
  }
  return queue.take_inside(index, inside);
}

void GroupBounder::take(const Bounding& bounding, BoxBounds& bounds) {
  ++search_.work.node_groups;
  search_.instant.count_served();
  BoxGroup& group = search_.queue.group(bounding.index);
  unsigned live = group.live & bounds.live;
  const unsigned doubt =
      in_doubt(search_.pair.A().nodes[group.node_a], search_.pair.B().nodes[group.node_b], bounds);
  if ((live & doubt) != 0) {
    live &= ~bound_in_double(group, live & doubt, bounds);
  }
  if (!search_.all_remembered && search_.freed > kManyFreed) {
    live &= ~free_triangles(group, live, bounds);
  }
  if (live == 0) {
    search_.queue.release_group(bounding.index);
    return;
  }
  const double t = search_.instant.t();
  group.larger_a = bounds.larger_a;
  group.larger_b = bounds.larger_b;
  group.far = bounds.far;
  group.live = static_cast<std::uint16_t>(live);
  group.next = prove(group.lanes, bounds.time, below(group.base - t), live);
  group.base = t;
  group.due = GroupQueue::due(group, group.next);
  // A step that does not advance the pair would repeat for ever: the pair is opened instead.
  if (bounding.far_lane != Bounding::kNew &&
      !(GroupQueue::due(group, group.lanes[bounding.far_lane]) > bounding.t)) {
    group.far &= static_cast<std::uint16_t>(~(1u << bounding.far_lane));
  }
  search_.queue.push_group(bounding.index);
}

bool GroupBounder::finishes(int lane, double apart, BoxBounds& bounds) const {
  if (search_.covered(search_.instant.t(), apart)) {
    return true;
  }
  bounds.time[lane] = std::max(bounds.time[lane], round_down(std::min(apart, 4.0)));
  return false;
}

unsigned GroupBounder::free_triangles(const BoxGroup& group, unsigned live, BoxBounds& bounds) {
  const HierarchyNode& a = search_.pair.A().nodes[group.node_a];
  const HierarchyNode& b = search_.pair.B().nodes[group.node_b];
  const PairInstant& instant = search_.instant;
  unsigned done = 0;
  for (unsigned lanes = live & lanes_of(a.leaves(), b.leaves()); lanes != 0; lanes &= lanes - 1) {
    const int k = std::countr_zero(lanes);
    TriangleEntry entry;
    entry.a = a.child_triangle(k / HierarchyNode::kWidth);
    entry.b = b.child_triangle(k % HierarchyNode::kWidth);
    ++search_.work.triangle_pairs;
    ++search_.work.steps;
    const double tau = triangles_.step_of(entry, instant.t());
    // A step of 0 may be the contact: the pair is followed when it is due.
    done |= tau > 0.0 && finishes(k, tau, bounds) ? 1u << k : 0u;
  }
  return done;
}

unsigned GroupBounder::in_doubt(const HierarchyNode& a, const HierarchyNode& b,
                                const BoxBounds& bounds) const {
  const unsigned triangle_pairs = lanes_of(a.leaves(), b.leaves());
  const unsigned large_triangles = (lanes_of(a.leaves(), b.used()) & bounds.larger_a) |
                                   (lanes_of(a.used(), b.leaves()) & bounds.larger_b);
  const bool corners_help = repeated_ < kFewRepeated + kRepeatedForOne * worth_repeating_;
  const unsigned doubt = (bounds.unsure | (corners_help ? large_triangles : 0u)) & ~triangle_pairs;
  // The box of a triangle that deforms is thick, as its axes suit the triangle at t = 0.
  return search_.pair.deforms() ? doubt | triangle_pairs : doubt;
}

unsigned GroupBounder::bound_in_double(const BoxGroup& group, unsigned lanes, BoxBounds& bounds) {
  const MovingPair& pair = search_.pair;
  const PairInstant& instant = search_.instant;
  std::array<PlacedBox, HierarchyNode::kWidth> b;
  for (unsigned slots = (lanes | lanes >> 4 | lanes >> 8 | lanes >> 12) & 15u; slots != 0;
       slots &= slots - 1) {
    const int j = std::countr_zero(slots);
    b[j] = pair.place_B(instant.state(), {group.node_b, static_cast<std::uint32_t>(j)});
  }
  const double enough = 2.0 * (search_.horizon() - instant.t());
  repeated_ += static_cast<std::uint64_t>(std::popcount(lanes));
  unsigned done = 0;
  PlacedBox a;
  int placed = -1;
  for (; lanes != 0; lanes &= lanes - 1) {
    const int k = std::countr_zero(lanes);
    const int i = k / HierarchyNode::kWidth;
    if (i != placed) {
      a = pair.place_A(instant.state(), {group.node_a, static_cast<std::uint32_t>(i)});
      placed = i;
    }
    const double apart = pair.time_apart(instant.state(), a, b[k % HierarchyNode::kWidth],
                                         search_.box_threshold, instant.error(), enough);
    worth_repeating_ += apart > 2.0 * static_cast<double>(bounds.time[k]) ? 1 : 0;
    done |= finishes(k, apart, bounds) ? 1u << k : 0u;
  }
  return done;
}

}  // namespace firstcontact::detail
