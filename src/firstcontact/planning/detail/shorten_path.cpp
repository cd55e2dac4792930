#include <firstcontact/planning/detail/shorten_path.h>

#include <algorithm>
#include <cstddef>
#include <utility>

namespace firstcontact::detail {
namespace {

constexpr double kWorthwhile = 1e-4;  // [-]  Part of the cost of a stretch that a replacement is to
                                      // save.
/// Tries in a row without gain, also as a share of a round, after which a round ends.
constexpr std::size_t kLongestWait = 25;
constexpr std::size_t kTriesOfWait = 4;
/// [-]  A round that saves a smaller part of the cost is the last one.
constexpr double kGainOfRound = 0.02;
/// Tries of the first round, by those of each further one.
constexpr std::size_t kShareOfRound = 2;

class Shortcuts {
 public:
  Shortcuts(PlanWork& work, std::vector<Configuration>& path, std::size_t tries)
      : work_(work),
        path_(path),
        tries_(tries),
        longest_wait_(std::max(kLongestWait, tries / kTriesOfWait)) {}

  void run(RandomNumbers& random) {
    skip_places();
    double before = cost(path_);
    const std::size_t further = std::max<std::size_t>(1, tries_ / kShareOfRound);
    while (path_.size() > 2) {
      run_round(random);
      skip_places();
      const double after = cost(path_);
      if (work_.is_over() || !(after < (1.0 - kGainOfRound) * before)) {
        break;
      }
      before = after;
      tries_ = further;
    }
  }

 private:
  /// Tries shortcuts, until there are no more tries or too many in a row did not help.
  void run_round(RandomNumbers& random) {
    left_ = tries_;
    std::size_t waited = 0;
    while (path_.size() > 2 && may_try() && waited < longest_wait_) {
      const bool in_one_part = !work_.space().is_body() && random.below(3) == 0;
      waited = (in_one_part ? cut_part(random) : cut(random)) ? 0 : waited + 1;
    }
  }

  /// A place on an edge of the path, and the number of that edge.
  struct OnPath {
    std::size_t edge = 0;
    Configuration q;
  };

  [[nodiscard]] bool may_try() const { return left_ > 0 && !work_.is_over(); }

  bool is_free(const Configuration& from, const Configuration& to) {
    left_ -= left_ > 0 ? 1 : 0;
    return work_.is_free(from, to);
  }

  [[nodiscard]] double length(const Configuration& from, const Configuration& to) const {
    return work_.space().distance(from, to);
  }

  [[nodiscard]] double cost(const std::vector<Configuration>& places) const {
    return cost_of(work_.space(), places);
  }

  /// Leads from each place straight to a far one: halves the way ahead until the edge is free.
  void skip_places() {
    for (std::size_t from = 0; from + 2 < path_.size(); ++from) {
      for (std::size_t to = path_.size() - 1; to > from + 1 && !work_.is_over();
           to = from + (to - from) / 2) {
        const std::vector<Configuration> stretch(path_.begin() + at(from),
                                                 path_.begin() + at(to + 1));
        if (length(path_[from], path_[to]) <= cost(stretch) &&
            work_.is_free(path_[from], path_[to])) {
          path_.erase(path_.begin() + at(from + 1), path_.begin() + at(to));
          break;
        }
      }
    }
  }

  static std::ptrdiff_t at(std::size_t k) { return static_cast<std::ptrdiff_t>(k); }

  /// Draws two places on different edges, the earlier one first; evenly along the path.
  bool draw(RandomNumbers& random, OnPath& first, OnPath& second) const {
    double a = random.uniform();
    double b = random.uniform();
    if (b < a) {
      std::swap(a, b);
    }
    const double whole = cost(path_);
    first = place_at(a * whole);
    second = place_at(b * whole);
    return first.edge < second.edge;
  }

  [[nodiscard]] OnPath place_at(double way) const {
    for (std::size_t edge = 0; edge + 1 < path_.size(); ++edge) {
      const double step = length(path_[edge], path_[edge + 1]);
      if (way < step) {
        return {edge, work_.space().interpolate(path_[edge], path_[edge + 1], way / step)};
      }
      way -= step;
    }
    return {path_.size() - 2, path_.back()};
  }

  /// The places from one before the first to one behind the second, both between them.
  [[nodiscard]] std::vector<Configuration> stretch_of(const OnPath& first,
                                                      const OnPath& second) const {
    return {path_.begin() + at(first.edge), path_.begin() + at(second.edge + 2)};
  }

  /// Takes a stretch into the path, if it is shorter and its inner edges are free.
  ///
  /// @param proven  whether the first and the last edge are parts of edges of the path
  bool take(const OnPath& first, const OnPath& second, std::vector<Configuration> places) {
    const std::vector<Configuration> before = stretch_of(first, second);
    places.erase(std::unique(places.begin(), places.end()), places.end());
    if (!(cost(places) < (1.0 - kWorthwhile) * cost(before))) {
      return false;
    }
    for (std::size_t k = 0; k + 1 < places.size(); ++k) {
      const bool is_piece = (places[k] == before.front() && places[k + 1] == first.q) ||
                            (places[k] == second.q && places[k + 1] == before.back());
      if (!is_piece && !is_free(places[k], places[k + 1])) {
        return false;
      }
    }
    path_.erase(path_.begin() + at(first.edge), path_.begin() + at(second.edge + 2));
    path_.insert(path_.begin() + at(first.edge), places.begin(), places.end());
    return true;
  }

  bool cut(RandomNumbers& random) {
    OnPath first;
    OnPath second;
    if (!draw(random, first, second)) {
      left_ -= 1;
      return false;
    }
    const Configuration& before = path_[first.edge];
    const Configuration& behind = path_[second.edge + 1];
    return take(first, second, {before, first.q, second.q, behind});
  }

  /// Leads one coordinate or one pose straight from one place to another; the others keep their
  /// way.
  bool cut_part(RandomNumbers& random) {
    OnPath first;
    OnPath second;
    const ConfigurationSpace& space = work_.space();
    const std::size_t coordinates = space.coordinates().size();
    const std::size_t part = random.below(coordinates + space.poses().size());
    const bool is_pose = part >= coordinates;
    const std::size_t begin = is_pose ? space.begin_of_pose(part - coordinates) : part;
    const std::size_t end = begin + (is_pose ? 7 : 1);
    if (!draw(random, first, second)) {
      left_ -= 1;
      return false;
    }
    std::vector<Configuration> inner = {first.q};
    inner.insert(inner.end(), path_.begin() + at(first.edge + 1),
                 path_.begin() + at(second.edge + 1));
    inner.push_back(second.q);
    const double whole = cost(inner);
    double way = 0.0;
    std::vector<Configuration> places = {path_[first.edge]};
    for (std::size_t k = 0; k < inner.size(); ++k) {
      way += k == 0 ? 0.0 : length(inner[k - 1], inner[k]);
      Configuration q = inner[k];
      if (k > 0 && k + 1 < inner.size()) {
        const Configuration straight = space.interpolate(first.q, second.q, way / whole);
        std::copy(straight.begin() + at(begin), straight.begin() + at(end), q.begin() + at(begin));
      }
      places.push_back(std::move(q));
    }
    places.push_back(path_[second.edge + 1]);
    return take(first, second, std::move(places));
  }

  PlanWork& work_;
  std::vector<Configuration>& path_;
  std::size_t tries_;
  std::size_t left_ = 0;
  std::size_t longest_wait_;
};

}  // namespace

void shorten_path(PlanWork& work, std::vector<Configuration>& path, std::size_t tries,
                  RandomNumbers& random) {
  if (path.size() > 2 && tries > 0) {
    Shortcuts(work, path, tries).run(random);
  }
}

}  // namespace firstcontact::detail
