#include <firstcontact/verification/detail/tested_pairs.h>

#include <algorithm>

#include <firstcontact/scene/scene.h>

namespace firstcontact::detail {

std::uint64_t TestedPairs::key(std::size_t a, std::size_t b) {
  return static_cast<std::uint64_t>(std::min(a, b)) << 32U |
         static_cast<std::uint64_t>(std::max(a, b));
}

TestedPairs::TestedPairs(const Scene& scene, const std::vector<bool>& rests)
    : has_robots_(!scene.robots.empty()), margin_(scene.options.margin), rests_(rests) {
  links_.resize(scene.bodies.size());
  paddings_.resize(scene.bodies.size());
  add_links(scene);
  add_attachments(scene);
  rests_.resize(links_.size());
  groups_of_.resize(links_.size());
  add_rules(scene);
  double greatest = margin_;
  for (const auto* margins : {&margins_, &group_margins_}) {
    for (const auto& [pair, margin] : *margins) {
      greatest = std::max(greatest, margin);
    }
  }
  const auto padding = std::max_element(paddings_.begin(), paddings_.end());
  greatest_margin_ = greatest + (padding == paddings_.end() ? 0.0 : 2.0 * *padding);
}

void TestedPairs::add_links(const Scene& scene) {
  for (std::size_t r = 0; r < scene.robots.size(); ++r) {
    const SceneRobot& robot = scene.robots[r];
    const RobotModel& model = robot.model;
    const std::size_t first = links_.size();
    for (std::size_t link = 0; link < model.links().size(); ++link) {
      std::size_t root = link;
      for (auto joint = model.parent_joint(root);
           joint && model.joints()[*joint].type == JointType::fixed;
           joint = model.parent_joint(root)) {
        root = model.parent_link(*joint);
      }
      links_.push_back(LinkOf{r, link, root});
      const auto padding = robot.padding.find(link);
      paddings_.push_back(padding == robot.padding.end() ? 0.0 : padding->second);
      if (const auto joint = model.parent_joint(link)) {
        joined_.insert(key(first + link, first + model.parent_link(*joint)));
      }
    }
    for (const DisabledPair& pair : robot.semantics.disabled) {
      ignored_.insert(key(first + pair.link, first + pair.other));
    }
  }
}

// A body that is ever attached does not rest.
void TestedPairs::add_attachments(const Scene& scene) {
  std::size_t first = scene.bodies.size();
  for (const SceneRobot& robot : scene.robots) {
    for (const SceneAttachment& attached : robot.attached) {
      rests_[attached.body] = false;
      const TimeSpan span{attached.from_time / scene.duration,
                          attached.to_time ? *attached.to_time / scene.duration : 1.0};
      held_[{attached.body, first + attached.link}].push_back(span);
      for (const std::size_t link : attached.touch_links) {
        if (link != attached.link) {
          held_[{attached.body, first + link}].push_back(span);
        }
      }
    }
    first += robot.model.links().size();
  }
  for (auto& [pair, spans] : held_) {
    std::sort(spans.begin(), spans.end(),
              [](const TimeSpan& a, const TimeSpan& b) { return a.from < b.from; });
  }
}

void TestedPairs::add_rules(const Scene& scene) {
  for (const BodyPair& pair : scene.ignored_pairs) {
    ignored_.insert(key(pair[0], pair[1]));
  }
  for (const PairMargin& pair : scene.pair_margins) {
    margins_[key(pair.bodies[0], pair.bodies[1])] = pair.margin;
  }
  for (std::size_t g = 0; g < scene.groups.size(); ++g) {
    for (const std::size_t member : scene.groups[g].bodies) {
      groups_of_[member].push_back(g);
    }
  }
  for (const GroupPair& pair : scene.ignored_groups) {
    ignored_groups_.insert(key(pair[0], pair[1]));
  }
  for (const GroupMargin& pair : scene.group_margins) {
    double& margin = group_margins_[key(pair.groups[0], pair.groups[1])];
    margin = std::max(margin, pair.margin);
  }
}

bool TestedPairs::is_left_out(const BodyPair& pair) const {
  const auto& a = links_[pair[0]];
  const auto& b = links_[pair[1]];
  if (a && b && a->robot == b->robot &&
      (a->rigid_root == b->rigid_root || joined_.contains(key(pair[0], pair[1])))) {
    return true;
  }
  return (has_robots_ && rests_[pair[0]] && rests_[pair[1]]) ||
         ignored_.contains(key(pair[0], pair[1]));
}

std::optional<double> TestedPairs::margin(const BodyPair& pair) const {
  if (is_left_out(pair)) {
    return std::nullopt;
  }
  std::optional<double> of_groups;
  for (const std::size_t g : groups_of_[pair[0]]) {
    for (const std::size_t h : groups_of_[pair[1]]) {
      if (ignored_groups_.contains(key(g, h))) {
        return std::nullopt;
      }
      if (const auto found = group_margins_.find(key(g, h)); found != group_margins_.end()) {
        of_groups = std::max(of_groups.value_or(0.0), found->second);
      }
    }
  }
  const auto own = margins_.find(key(pair[0], pair[1]));
  const double margin = own != margins_.end() ? own->second : of_groups.value_or(margin_);
  return margin + paddings_[pair[0]] + paddings_[pair[1]];
}

std::vector<BodyPair> TestedPairs::held_pairs() const {
  std::vector<BodyPair> pairs;
  for (const auto& [pair, spans] : held_) {
    pairs.push_back(pair);
  }
  return pairs;
}

std::vector<TimeSpan> TestedPairs::spans(const BodyPair& pair) const {
  const auto held = held_.find({std::min(pair[0], pair[1]), std::max(pair[0], pair[1])});
  if (held == held_.end()) {
    return {{0.0, 1.0}};
  }
  std::vector<TimeSpan> spans;
  double from = 0.0;
  for (const TimeSpan& span : held->second) {
    if (from < span.from) {
      spans.push_back({from, span.from});
    }
    from = std::max(from, span.to);
  }
  if (from < 1.0) {
    spans.push_back({from, 1.0});
  }
  return spans;
}

}  // namespace firstcontact::detail
