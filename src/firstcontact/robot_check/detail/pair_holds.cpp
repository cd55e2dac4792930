#include <firstcontact/robot_check/detail/pair_holds.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include <firstcontact/parallel/parallel_for.h>
#include <firstcontact/robot_check/detail/geometry_search.h>

namespace firstcontact::detail {
namespace {

HeldStretch stretch_from(const RobotTimeline& timeline, std::size_t pair, std::size_t piece,
                         const RobotCheckOptions& options, LinkWorkspace& workspace) {
  const double margin = timeline.pairs()[pair].margin;
  HeldStretch stretch{.first_piece = piece, .hold = {}, .work = {}};
  StartGap start;
  for (const auto& geometries : timeline.geometry_pairs(timeline.pairs()[pair])) {
    const GeometryCandidate candidate{.window = timeline.piece(piece),
                                      .piece = piece,
                                      .pair = pair,
                                      .geometries = geometries,
                                      .threshold = margin};
    GeometrySearch search(timeline, candidate, options, workspace);
    start = nearer(start, search.start_gap(stretch.work));
  }
  stretch.hold = keep_half(start, margin);
  return stretch;
}

std::vector<HeldStretch> stretches_of(const RobotTimeline& timeline, std::size_t pair,
                                      const RobotCheckOptions& options, LinkWorkspace& workspace) {
  std::vector<HeldStretch> stretches;
  bool goes_on = false;
  for (std::size_t piece = 0; piece < timeline.piece_count(); ++piece) {
    const bool is_tested = timeline.is_tested(timeline.pairs()[pair], piece);
    if (is_tested && !goes_on) {
      stretches.push_back(stretch_from(timeline, pair, piece, options, workspace));
    }
    goes_on = is_tested;
  }
  return stretches;
}

}  // namespace

PairHolds::PairHolds(const RobotTimeline& timeline, const RobotCheckOptions& options,
                     LinkWorkspaces& workspaces)
    : timeline_(timeline), stretches_(timeline.pairs().size()) {
  parallel_for(options.threads, stretches_.size(), [&](std::size_t pair) {
    stretches_[pair] = stretches_of(timeline, pair, options, workspaces.local());
  });
  for (const std::vector<HeldStretch>& stretches : stretches_) {
    double greatest = 0.0;
    for (const HeldStretch& stretch : stretches) {
      greatest = std::max(greatest, stretch.hold.distance);
    }
    greatest_.push_back(greatest);
  }
}

double PairHolds::least(std::size_t pair) const {
  double least = std::numeric_limits<double>::infinity();
  for (const HeldStretch& stretch : stretches_[pair]) {
    least = std::min(least, stretch.hold.distance);
  }
  return std::isfinite(least) ? least : timeline_.pairs()[pair].margin;
}

void PairHolds::apply(GeometryCandidate& candidate) const {
  for (const HeldStretch& stretch : stretches_[candidate.pair]) {
    if (stretch.first_piece <= candidate.piece) {
      candidate.hold = stretch.hold;
    }
  }
  candidate.threshold = timeline_.pairs()[candidate.pair].margin;
}

}  // namespace firstcontact::detail
