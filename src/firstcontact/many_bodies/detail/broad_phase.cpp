#include <firstcontact/many_bodies/detail/broad_phase.h>

#include <algorithm>
#include <limits>
#include <optional>

#include <firstcontact/geometry/hierarchy.h>

namespace firstcontact::detail {
namespace {

constexpr std::size_t kPairsPerBody = 8;  // With more, shorter intervals take less work.
constexpr double kShortest = 0x1p-10;
constexpr std::size_t kUnlimited = std::numeric_limits<std::size_t>::max() / 8;

}  // namespace

BroadPhase::BroadPhase(const BodySet& bodies, Workers& workers, BroadPhaseData& data)
    : bodies_(bodies),
      workers_(workers),
      data_(data),
      margins_(bodies.rules().greatest_margins(bodies.size())) {}

void BroadPhase::for_each_interval(
    const std::function<bool(const TimeWindow&, const std::vector<Candidate>&)>& use) {
  std::vector<TimeWindow> left{{0.0, 1.0}};
  while (!left.empty()) {
    const TimeWindow window = left.back();
    left.pop_back();
    if (!find_overlaps(window)) {
      const double middle = 0.5 * (window.begin + window.end);
      left.push_back({middle, window.end});
      left.push_back({window.begin, middle});
      continue;
    }
    find_candidates(window);
    if (!use(window, data_.candidates)) {
      return;
    }
  }
}

BallPath BroadPhase::ball(std::size_t body, double more) const {
  const Shape& shape = bodies_.shape(body);
  return {bodies_.centre_path(body), shape.hierarchy().radius + shape.radius() + more};
}

/// Places the boxes. At least half of a pair's margin belongs to each body.
void BroadPhase::place_boxes(const TimeWindow& window) {
  data_.boxes.resize(bodies_.size());
  workers_.for_each(bodies_.size(), 64, [&](std::size_t k) {
    data_.boxes[k] = swept_box(ball(k, 0.5 * margins_[k]), window);
  });
}

bool BroadPhase::join(const TimeWindow& window, std::size_t most) {
  place_boxes(window);
  data_.overlaps.clear();
  return data_.join.join(data_.boxes, most, data_.overlaps);
}

/// Finds overlaps; false where the interval is better halved.
bool BroadPhase::find_overlaps(const TimeWindow& window) {
  const std::size_t usual = kPairsPerBody * bodies_.size();
  if (join(window, usual)) {
    return true;
  }
  if (window.end - window.begin <= kShortest) {
    return join(window, kUnlimited);
  }
  const double middle = 0.5 * (window.begin + window.end);
  join({middle, middle}, kUnlimited);
  const std::size_t at_one_time = data_.overlaps.size();
  return 2 * at_one_time > usual && join(window, 4 * at_one_time);
}

void BroadPhase::find_candidates(const TimeWindow& window) {
  std::vector<Candidate>& candidates = data_.candidates;
  candidates.clear();
  for (const BodyPair& pair : data_.overlaps) {
    if (const std::optional<double> margin = bodies_.rules().margin(pair)) {
      candidates.push_back({0.0, pair, *margin});
    }
  }
  workers_.for_each(candidates.size(), 32, [&](std::size_t k) {
    Candidate& c = candidates[k];
    c.free_until = apart_until(ball(c.bodies[0], 0.0), ball(c.bodies[1], 0.0), c.margin, window);
  });
  std::erase_if(candidates, [](const Candidate& c) { return c.free_until > 1.0; });
  std::sort(candidates.begin(), candidates.end());
}

}  // namespace firstcontact::detail
