// Plans through narrow passages of known clearance: RRT-Connect with and without contacts. Twins of
// the passages are closed, so that no plan exists.
//
//   narrow_benchmark [--families A,B] [--contacts none,sample,slide,both] [--clearances 0.1,0.01]
//                    [--seeds N] [--time SECONDS] [--twins -0.01] [OUTPUT.json]
//
// Clearances are fractions of the width of the body; those of twins are negative. Times are
// processor times of one thread until the first path. Medians count runs that ended without a path
// as censored: E. Kaplan, P. Meier, "Nonparametric estimation from incomplete observations",
// Journal of the American Statistical Association 53 (1958). Every path is proven once more. The
// exit status is 1 where a path is not proven, or where a twin has a path.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <limits>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include <firstcontact/edges/edge_checker.h>
#include <firstcontact/planning/plan_path.h>

#include "benchmarks/support/timing.h"
#include "support/narrow_passages.h"

namespace firstcontact::benchmarks {
namespace {

using nlohmann::json;

struct Settings {
  std::vector<std::string> families = {};
  std::vector<std::string> contacts = {"none", "sample", "slide", "both"};
  std::vector<double> clearances = {0.3, 0.1, 0.03, 0.01};
  std::vector<double> twins = {-0.01};
  std::uint64_t seeds = 30;
  double time = 60.0;  // [s]
  std::string output;
};

/// Time of an event, or the time up to which it had not happened (a censored run).
struct Observation {
  double time = 0.0;  // [s]
  bool is_seen = false;
};

/// [s]  Estimates the median time by Kaplan and Meier; infinite where fewer than half have a path.
double censored_median(std::vector<Observation> all) {
  std::sort(all.begin(), all.end(), [](const Observation& x, const Observation& y) {
    return x.time != y.time ? x.time < y.time : x.is_seen && !y.is_seen;
  });
  double open = 1.0;  // Estimated fraction of the runs that have no path yet.
  for (std::size_t k = 0; k < all.size(); ++k) {
    const auto at_risk = static_cast<double>(all.size() - k);
    open *= all[k].is_seen ? (at_risk - 1.0) / at_risk : 1.0;
    if (open <= 0.5) {
      return all[k].time;
    }
  }
  return std::numeric_limits<double>::infinity();
}

class Campaign {
 public:
  explicit Campaign(const Settings& settings) : settings_(settings) {}

  int run() {
    std::printf("%-9s %10s %-7s %8s %10s %8s %8s %8s\n", "family", "clearance", "contacts",
                "solved", "median[s]", "p. near", "active", "most");
    for (const std::string& family : settings_.families) {
      for (const double clearance : settings_.clearances) {
        for (const std::string& contacts : settings_.contacts) {
          cell(family, clearance, contacts);
        }
      }
      for (const double clearance : settings_.twins) {
        for (const std::string& contacts : settings_.contacts) {
          cell(family, clearance, contacts);
        }
      }
    }
    if (!settings_.output.empty()) {
      std::ofstream(settings_.output) << rows_.dump(1) << '\n';
    }
    std::printf("paths: %zu, not proven again: %zu; answers of twins: %zu\n", paths_, unproven_,
                answers_of_twins_);
    return unproven_ == 0 && answers_of_twins_ == 0 ? 0 : 1;
  }

 private:
  void cell(const std::string& family, double share, const std::string& contacts) {
    const auto use = std::find(kContactUseWords.begin(), kContactUseWords.end(), contacts);
    const test::NarrowPassage passage = test::narrow_passage(family, share * 0.1);
    std::vector<Observation> seen;
    ContactStatistics counts;
    json runs = json::array();
    for (std::uint64_t seed = 1; seed <= settings_.seeds; ++seed) {
      const double begin = thread_time();
      const PlanResult result =
          plan_path(passage.scene, passage.start, {passage.goal},
                    {.contacts = static_cast<ContactUse>(use - kContactUseWords.begin()),
                     .seed = seed,
                     .time = settings_.time,
                     .shortcuts = 0,
                     .threads = 1});
      const double seconds = 1e-6 * (thread_time() - begin);
      const bool is_solved = result.verdict == PlanVerdict::proven;
      seen.push_back({seconds, is_solved});
      take(result, passage, counts);
      runs.push_back({{"seed", seed},
                      {"seconds", seconds},
                      {"solved", is_solved},
                      {"edges", result.statistics.edges_checked},
                      {"undecided", result.statistics.undecided},
                      {"nodes", result.statistics.nodes},
                      {"places", result.path.size()}});
    }
    report(family, share, contacts, seen, counts, std::move(runs));
  }

  void take(const PlanResult& result, const test::NarrowPassage& passage,
            ContactStatistics& counts) {
    const ContactStatistics& more = result.statistics.contacts;
    counts.slides += more.slides;
    counts.pushes += more.pushes;
    counts.nodes += more.nodes;
    counts.in_contact += more.in_contact;
    counts.active += more.active;
    counts.most_active = std::max(counts.most_active, more.most_active);
    if (result.verdict != PlanVerdict::proven) {
      return;
    }
    ++paths_;
    answers_of_twins_ += passage.clearance < 0.0 ? 1 : 0;
    const EdgeChecker fresh(passage.scene, {.tolerance = 1e-7, .extra_clearance = 0.0});
    bool is_proven = result.path.front() == passage.start && result.path.back() == passage.goal;
    for (std::size_t k = 0; k + 1 < result.path.size(); ++k) {
      is_proven = is_proven && fresh.check_quickly(result.path[k], result.path[k + 1]).verdict ==
                                   EdgeVerdict::free;
    }
    unproven_ += is_proven ? 0 : 1;
  }

  void report(const std::string& family, double share, const std::string& contacts,
              const std::vector<Observation>& seen, const ContactStatistics& counts, json runs) {
    const auto solved =
        std::count_if(seen.begin(), seen.end(), [](const Observation& one) { return one.is_seen; });
    const double median = censored_median(seen);
    const auto nodes = static_cast<double>(std::max<std::size_t>(counts.nodes, 1));
    const double near = static_cast<double>(counts.in_contact) / nodes;
    const double active = static_cast<double>(counts.active) / nodes;
    std::printf("%-9s %10g %-7s %5td/%-3zu %9.4g %8.2f %8.2f %8zu\n", family.c_str(), share,
                contacts.c_str(), solved, seen.size(), median, near, active, counts.most_active);
    std::fflush(stdout);
    rows_.push_back({{"family", family},
                     {"clearance", share},
                     {"contacts", contacts},
                     {"solved", solved},
                     {"runs", std::move(runs)},
                     {"median", std::isfinite(median) ? json(median) : json()},
                     {"near", near},
                     {"active", active},
                     {"most_active", counts.most_active},
                     {"slides", counts.slides},
                     {"pushes", counts.pushes}});
  }

  const Settings& settings_;
  json rows_ = json::array();
  std::size_t paths_ = 0;
  std::size_t unproven_ = 0;
  std::size_t answers_of_twins_ = 0;
};

std::vector<std::string> words_of(const std::string& text) {
  std::vector<std::string> words;
  std::istringstream stream(text);
  for (std::string word; std::getline(stream, word, ',');) {
    words.push_back(word);
  }
  return words;
}

std::vector<double> numbers_of(const std::string& text) {
  std::vector<double> numbers;
  for (const std::string& word : words_of(text)) {
    numbers.push_back(std::stod(word));
  }
  return numbers;
}

Settings settings_of(int count, char** arguments) {
  Settings settings;
  settings.families = {test::narrow_families().begin(), test::narrow_families().end()};
  for (int k = 1; k < count; ++k) {
    const std::string name = arguments[k];
    const bool is_option = name.starts_with("--") && k + 1 < count;
    const std::string value = is_option ? arguments[++k] : "";
    if (name == "--families") {
      settings.families = words_of(value);
    } else if (name == "--contacts") {
      settings.contacts = words_of(value);
    } else if (name == "--clearances") {
      settings.clearances = numbers_of(value);
    } else if (name == "--twins") {
      settings.twins = numbers_of(value);
    } else if (name == "--seeds") {
      settings.seeds = std::stoull(value);
    } else if (name == "--time") {
      settings.time = std::stod(value);
    } else if (!is_option && !name.starts_with("--")) {
      settings.output = name;
    } else {
      throw std::invalid_argument("unknown option " + name);
    }
  }
  for (const std::string& word : settings.contacts) {
    if (std::find(kContactUseWords.begin(), kContactUseWords.end(), word) ==
        kContactUseWords.end()) {
      throw std::invalid_argument("--contacts: expected none, sample, slide or both, got " + word);
    }
  }
  return settings;
}

}  // namespace
}  // namespace firstcontact::benchmarks

int main(int count, char** arguments) {
  try {
    const firstcontact::benchmarks::Settings settings =
        firstcontact::benchmarks::settings_of(count, arguments);
    return firstcontact::benchmarks::Campaign(settings).run();
  } catch (const std::exception& error) {
    std::cerr << "narrow_benchmark: " << error.what() << '\n';
    return 2;
  }
}
