#include <firstcontact/planning/detail/contact_growth.h>

#include <algorithm>
#include <array>
#include <utility>

namespace firstcontact::detail {
namespace {

constexpr double kSamePassage = 0.02;    // [-]  Part of the range; two places so near are one.
constexpr std::size_t kFirstDraws = 64;  // Draws of gaps before they become more seldom.

/// Edges in contact that are allowed for each other edge, until so many others were checked.
struct Ration {
  std::size_t until;
  double share;
};
constexpr std::array<Ration, 2> kRations = {{{500, 0.02}, {1500, 0.3}}};
constexpr double kLastShare = 4.0;

/// Edges that the ration must leave before a way in contact begins; such a way takes dozens.
constexpr double kFewEdges = 10.0;

}  // namespace

ContactGrowth::ContactGrowth(PlanWork& work, ContactUse use, double range)
    : work_(work), use_(use), range_(range), random_(~work.options().seed) {
  if (use == ContactUse::sample || use == ContactUse::both) {
    gaps_.emplace(work.scene());
  }
}

ContactSteering& ContactGrowth::steering() {
  if (!steering_) {
    steering_.emplace(work_, work_.scene(), range_);
  }
  return *steering_;
}

void ContactGrowth::next(bool is_stuck) {
  is_stuck_ = is_stuck;
  turn_ = Turn::edges;
  has_begun_ = has_begun_ || is_due();
  if (use_ == ContactUse::none || use_ == ContactUse::slide) {
    return;
  }
  // Drawn also where nothing is due: it may become due before the tree has grown. Blocked edges
  // come first then, and would leave nothing for pushes and passages.
  const std::size_t drawn = random_.below(4);
  const bool has_gaps = gaps_->may_draw();
  if (is_stuck) {
    turn_ = drawn < 2 && use_ == ContactUse::both ? Turn::pushes : Turn::edges;
    return;
  }
  turn_ = drawn == 0                               ? Turn::edges
          : drawn == 1 && use_ == ContactUse::both ? Turn::pushes
          : has_gaps                               ? Turn::passages
                                                   : Turn::edges;
}

bool ContactGrowth::is_due() const {
  if (use_ == ContactUse::none) {
    return false;
  }
  if (is_stuck_) {
    return true;
  }
  const std::size_t others = work_.counts().edges_checked - spent_ - leaving_;
  double allowed = -kFewEdges;
  std::size_t from = 0;
  for (const Ration& ration : kRations) {
    allowed += ration.share * static_cast<double>(std::min(others, ration.until) - from);
    if (others <= ration.until) {
      return static_cast<double>(spent_) <= allowed;
    }
    from = ration.until;
  }
  return static_cast<double>(spent_) <= allowed + kLastShare * static_cast<double>(others - from);
}

std::optional<std::size_t> ContactGrowth::take(PlanTree& tree, std::size_t from,
                                               const ContactWay& way) {
  if (way.places.empty()) {
    return std::nullopt;
  }
  double since = 0.0;
  std::size_t node = from;
  for (std::size_t k = 0; k < way.places.size(); ++k) {
    since += work_.space().distance(tree[node], way.places[k]);
    const bool is_last = k + 1 == way.places.size();
    const bool is_found = is_last || since >= range_;
    node = tree.add(way.places[k], node, is_found);
    since = is_found ? 0.0 : since;
  }
  ContactStatistics& counts = work_.counts().contacts;
  ++counts.nodes;
  counts.in_contact += way.is_near ? 1 : 0;
  counts.active += way.active;
  counts.most_active = std::max(counts.most_active, way.active);
  if (way.is_near || way.active > 0) {
    tree.mark(node);
  }
  return node;
}

std::optional<ContactGrowth::Followed> ContactGrowth::follow(PlanTree& tree, std::size_t from,
                                                             const Configuration& target) {
  return turn_ == Turn::edges ? go(tree, from, target) : std::nullopt;
}

std::optional<ContactGrowth::Followed> ContactGrowth::follow_to_passage(
    PlanTree& tree, std::size_t from, const Configuration& target) {
  return use_ == ContactUse::both ? go(tree, from, target) : std::nullopt;
}

std::optional<ContactGrowth::Followed> ContactGrowth::go(PlanTree& tree, std::size_t from,
                                                         const Configuration& target) {
  if (!is_due()) {
    return std::nullopt;
  }
  return counted([&]() -> std::optional<Followed> {
    std::size_t node = from;
    const EdgeAnswer answer = work_.check(tree[from], target);
    if (answer.fraction > 0.0) {
      const Configuration begin = tree[from];
      node = tree.add(work_.space().interpolate(begin, target, kShortOfContact * answer.fraction),
                      from, false);
    }
    const Configuration at_contact = tree[node];
    ++work_.counts().contacts.slides;
    const ContactWay way = use_ == ContactUse::sample ? steering().lift(at_contact)
                                                      : steering().slide(at_contact, target);
    const std::optional<std::size_t> end = take(tree, node, way);
    if (!end && node != from) {
      tree.show(node);
    }
    return end ? std::optional(Followed{*end, way.reaches_target}) : std::nullopt;
  });
}

std::vector<std::array<Eigen::VectorXd, 2>> ContactGrowth::ways_out(const Configuration& from) {
  return use_ == ContactUse::both ? steering().ways_out(from)
                                  : std::vector<std::array<Eigen::VectorXd, 2>>{};
}

std::optional<ContactGrowth::Left> ContactGrowth::leave(PlanTree& tree, std::size_t from,
                                                        const Eigen::VectorXd& direction) {
  ++work_.counts().contacts.pushes;
  const std::size_t before = work_.counts().edges_checked;
  const Configuration begin = tree[from];
  const ContactWay way = work_.thoroughly([&] { return steering().push(begin, direction); });
  const std::optional<std::size_t> end = take(tree, from, way);
  leaving_ += work_.counts().edges_checked - before;
  return end ? std::optional(Left{*end, !steering().is_near(tree[*end])}) : std::nullopt;
}

std::optional<std::size_t> ContactGrowth::push(PlanTree& tree) {
  if (turn_ != Turn::pushes || tree.marked().empty() || !is_due()) {
    return std::nullopt;
  }
  return counted([&] {
    const std::vector<std::size_t>& marked = tree.marked();
    const std::size_t from =
        random_.below(2) == 0 ? marked.back() : marked[random_.below(marked.size())];
    ++work_.counts().contacts.pushes;
    const Configuration begin = tree[from];
    return take(tree, from, steering().push(begin, steering().direction(random_)));
  });
}

void ContactGrowth::find_passage() {
  ++draws_;
  const std::optional<GapSampler::Place> place = gaps_->draw(random_);
  const ConfigurationSpace& space = work_.space();
  if (!place || !space.holds(place->q) ||
      passages_.distance(space, place->q) < kSamePassage * range_ || !work_.is_free(place->q)) {
    return;
  }
  PlanTree tree(space);
  const std::size_t root = tree.add(place->q, kNoParent);
  tree.mark(root);
  if (use_ == ContactUse::both) {
    Eigen::VectorXd open = Eigen::VectorXd::Zero(6);
    open.head<3>() = range_ * place->open;
    for (const double sign : {1.0, -1.0}) {
      ++work_.counts().contacts.pushes;
      take(tree, root, steering().push(place->q, sign * open));
    }
  }
  passages_.add(std::move(tree));
}

std::optional<PassageTrees::Node> ContactGrowth::passage(std::size_t tree,
                                                         const Configuration& near) {
  if (turn_ != Turn::passages || !is_due()) {
    return std::nullopt;
  }
  // Draws become more seldom, but never end.
  if (draws_ < kFirstDraws || random_.below(draws_) < kFirstDraws) {
    counted([&] {
      find_passage();
      return true;
    });
  }
  return passages_.draw(work_.space(), tree, near, random_);
}

}  // namespace firstcontact::detail
