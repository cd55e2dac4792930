#include <firstcontact/many_bodies/pair_rules.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include <firstcontact/math/number_text.h>

namespace firstcontact {
namespace {

double checked(double margin) {
  if (!(margin >= 0.0 && std::isfinite(margin))) {
    throw std::invalid_argument("PairRules: a margin must be finite and >= 0, got " +
                                detail::shortest(margin));
  }
  return margin;
}

std::uint64_t code(const BodyPair& pair) {
  if (pair[0] == pair[1]) {
    throw std::invalid_argument("PairRules: a pair needs two bodies, got " +
                                std::to_string(pair[0]) + " twice");
  }
  return static_cast<std::uint64_t>(std::min(pair[0], pair[1])) << 32 |
         static_cast<std::uint64_t>(std::max(pair[0], pair[1]));
}

}  // namespace

PairRules::PairRules(double margin) : margin_(checked(margin)), least_(margin) {}

double PairRules::take(double margin) {
  least_ = std::min(least_, checked(margin));
  return margin;
}

void PairRules::ignore(const BodyPair& pair) { pairs_[code(pair)] = {}; }

void PairRules::set_margin(const BodyPair& pair, double margin) {
  const auto [rule, is_new] = pairs_.try_emplace(code(pair), Rule{take(margin)});
  if (!is_new && rule->second.margin) {
    rule->second.margin = margin;
  }
}

std::size_t PairRules::add_group(std::vector<std::size_t> bodies) {
  std::vector<bool> members;
  for (const std::size_t body : bodies) {
    members.resize(std::max(members.size(), body + 1));
    members[body] = true;
  }
  groups_.push_back(std::move(bodies));
  is_member_.push_back(std::move(members));
  return groups_.size() - 1;
}

void PairRules::add(std::size_t group, std::size_t other, const Rule& rule) {
  if (std::max(group, other) >= groups_.size()) {
    throw std::invalid_argument("PairRules: there is no group " +
                                std::to_string(std::max(group, other)));
  }
  group_rules_.push_back({group, other, rule});
}

void PairRules::ignore_groups(std::size_t group, std::size_t other) { add(group, other, {}); }

void PairRules::set_group_margin(std::size_t group, std::size_t other, double margin) {
  add(group, other, {take(margin)});
}

std::optional<double> PairRules::margin(const BodyPair& pair) const {
  std::optional<double> margin;
  for (const GroupRule& rule : group_rules_) {
    if ((contains(rule.group, pair[0]) && contains(rule.other, pair[1])) ||
        (contains(rule.group, pair[1]) && contains(rule.other, pair[0]))) {
      if (!rule.rule.margin) {
        return std::nullopt;
      }
      margin = std::max(margin.value_or(0.0), *rule.rule.margin);
    }
  }
  if (!pairs_.empty()) {
    if (const auto own = pairs_.find(code(pair)); own != pairs_.end()) {
      return own->second.margin;
    }
  }
  return margin.value_or(margin_);
}

std::vector<double> PairRules::greatest_margins(std::size_t n) const {
  std::vector<double> greatest(n, margin_);
  const auto raise = [&](std::size_t body, double margin) {
    if (body < n) {
      greatest[body] = std::max(greatest[body], margin);
    }
  };
  for (const auto& [pair, rule] : pairs_) {
    raise(static_cast<std::size_t>(pair >> 32), rule.margin.value_or(0.0));
    raise(static_cast<std::size_t>(pair & 0xffffffffu), rule.margin.value_or(0.0));
  }
  for (const GroupRule& rule : group_rules_) {
    for (const std::size_t group : {rule.group, rule.other}) {
      for (const std::size_t body : groups_[group]) {
        raise(body, rule.rule.margin.value_or(0.0));
      }
    }
  }
  return greatest;
}

}  // namespace firstcontact
