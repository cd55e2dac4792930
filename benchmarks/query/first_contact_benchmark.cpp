// Times first contacts of random motions, side by side with FCL 0.7.
//
//   first_contact_benchmark [--quick] OUTPUT.json
//
// Every query goes to all methods in turn, so that load on the machine affects all of them alike.
// Times are processor times of the one thread. "Cold": other data filled the caches before the
// query. "Warm": the same query again, the median of three.

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include <firstcontact/mesh_files/read_mesh.h>
#include <firstcontact/query/first_contact.h>

#include "benchmarks/support/fcl_peer.h"
#include "benchmarks/support/normalised_mesh.h"
#include "benchmarks/support/random_motion.h"
#include "benchmarks/support/timing.h"
#include "benchmarks/support/torus_knot.h"

namespace firstcontact::benchmarks {
namespace {

using nlohmann::json;

constexpr double kTolerance = 1e-6;  // [m]
constexpr double kWrongTime = 1e-3;  // [-]  Error from which a peer's time counts as wrong.
constexpr std::uint64_t kSeed = 20261121;

struct Scale {
  int motions = 500;
  /// Limits the motions that fcl::continuousCollide tests, by the sum of their triangles.
  ///
  /// Its time grows with that sum: about a second for 70,000 triangles.
  std::size_t continuous_collide_triangles = 1'500'000;
};

/// Times of one method, or its ratios to ours; hits and misses are separate.
class Sample {
 public:
  void add(double value, bool hit) { (hit ? hits_ : misses_).push_back(value); }

  [[nodiscard]] json summary() const {
    std::vector<double> all = hits_;
    all.insert(all.end(), misses_.begin(), misses_.end());
    return {{"all", quantiles(all)}, {"hits", quantiles(hits_)}, {"misses", quantiles(misses_)}};
  }

 private:
  static json quantiles(const std::vector<double>& values) {
    return {{"count", values.size()},
            {"median", quantile(values, 0.5)},
            {"p90", quantile(values, 0.9)},
            {"p99", quantile(values, 0.99)},
            {"max", quantile(values, 1.0)}};
  }

  std::vector<double> hits_;
  std::vector<double> misses_;
};

/// Comparison of a peer's answers with those of the distance loop.
struct Verdicts {
  int asked = 0;
  int missed = 0;
  int invented = 0;
  int late = 0;
  int early = 0;

  void judge(const PeerAnswer& answer, const PeerAnswer& truth) {
    ++asked;
    missed += truth.contact && !answer.contact ? 1 : 0;
    invented += answer.contact && !truth.contact ? 1 : 0;
    if (truth.contact && answer.contact) {
      late += answer.t > truth.t + kWrongTime ? 1 : 0;
      early += answer.t < truth.t - kWrongTime ? 1 : 0;
    }
  }

  [[nodiscard]] json summary() const {
    return {{"asked", asked},
            {"missed", missed},
            {"invented", invented},
            {"late", late},
            {"early", early}};
  }
};

/// One pair of meshes, tested by every method.
class Comparison {
 public:
  Comparison(std::string name, const Mesh& mesh)
      : name_(std::move(name)), shape_(mesh), fcl_(mesh, mesh) {}

  json run(const Scale& scale) {
    const auto motions = random_motions(shape_, shape_, scale.motions, kSeed);
    const std::size_t for_continuous_collide =
        scale.continuous_collide_triangles / shape_.mesh().triangles.size();
    for (std::size_t i = 0; i < motions.size(); ++i) {
      ask(motions[i], i < for_continuous_collide);
    }
    return summary();
  }

 private:
  void ask(const PlainMotionPair& pair, bool with_continuous_collide) {
    const Motion motion_A = pair.A.motion();
    const Motion motion_B = pair.B.motion();
    const auto query = [&] {
      first_contact({shape_, motion_A}, {shape_, motion_B}, workspace_, options_, result_);
    };
    evict_caches();
    const double cold = time_of(query);
    const double warm = quantile({time_of(query), time_of(query), time_of(query)}, 0.5);
    const auto query_without_list = [&] {
      first_contact({shape_, motion_A}, {shape_, motion_B}, workspace_, without_list_,
                    result_without_list_);
    };
    const double without_list = quantile(
        {time_of(query_without_list), time_of(query_without_list), time_of(query_without_list)},
        0.5);
    PeerAnswer truth;
    const double loop = time_of([&] { truth = fcl_.distance_loop(pair, kTolerance); });
    PeerAnswer oriented;
    const double oriented_time = time_of([&] { oriented = fcl_.oriented_advancement(pair); });

    const bool hit = truth.contact;
    times_["firstcontact, cold"].add(cold, hit);
    times_["firstcontact, warm"].add(warm, hit);
    times_["firstcontact, warm, without the list of contacts"].add(without_list, hit);
    const auto add_peer = [&](const std::string& peer, double time) {
      times_[peer].add(time, hit);
      ratios_[peer]["cold"].add(time / cold, hit);
      ratios_[peer]["warm"].add(time / warm, hit);
    };
    add_peer("loop over fcl::distance", loop);
    add_peer("FCL oriented advancement", oriented_time);
    verdicts_["FCL oriented advancement"].judge(oriented, truth);
    compare(pair, truth);
    if (with_continuous_collide) {
      PeerAnswer answer;
      const double time = time_of([&] { answer = fcl_.continuous_collide(pair); });
      add_peer("fcl::continuousCollide", time);
      verdicts_["fcl::continuousCollide"].judge(answer, truth);
    }
  }

  /// Compares our answer with that of the distance loop, and with FCL's distance at our time.
  void compare(const PlainMotionPair& pair, const PeerAnswer& truth) {
    const bool hit = result_.verdict == Verdict::contact;
    if (hit != truth.contact || result_.verdict == Verdict::undecided) {
      ++disagreements_;
      return;
    }
    if (hit) {
      greatest_time_difference_ =
          std::max(greatest_time_difference_, std::abs(result_.t - truth.t));
      greatest_distance_ = std::max(greatest_distance_, fcl_.distance(pair, result_.t));
    }
    node_groups_.push_back(static_cast<double>(result_.work.node_groups));
    triangle_pairs_.push_back(static_cast<double>(result_.work.triangle_pairs));
    steps_.push_back(static_cast<double>(result_.work.steps));
  }

  [[nodiscard]] json summary() const {
    json out = {{"pair", name_},
                {"triangles", shape_.mesh().triangles.size()},
                {"disagreements_with_loop", disagreements_},
                {"greatest_time_difference_to_loop", greatest_time_difference_},
                {"greatest_fcl_distance_at_contact_m", greatest_distance_},
                {"median_work",
                 {{"node_groups", quantile(node_groups_, 0.5)},
                  {"triangle_pairs", quantile(triangle_pairs_, 0.5)},
                  {"steps", quantile(steps_, 0.5)}}}};
    for (const auto& [method, times] : times_) {
      out["times_us"][method] = times.summary();
    }
    for (const auto& [peer, ratios] : ratios_) {
      for (const auto& [caches, values] : ratios) {
        out["ratios"][peer][caches] = values.summary();
      }
    }
    for (const auto& [method, verdicts] : verdicts_) {
      out["wrong_answers"][method] = verdicts.summary();
    }
    return out;
  }

  std::string name_;
  Shape shape_;
  FclPeer fcl_;
  FirstContactOptions options_ = {.tolerance = kTolerance};
  Workspace workspace_;
  FirstContactResult result_;
  FirstContactOptions without_list_ = {.tolerance = kTolerance, .contacts = ContactState::first};
  FirstContactResult result_without_list_;
  std::map<std::string, Sample> times_;
  std::map<std::string, std::map<std::string, Sample>> ratios_;  // by peer, then cold and warm
  std::map<std::string, Verdicts> verdicts_;
  int disagreements_ = 0;
  double greatest_time_difference_ = 0.0;
  double greatest_distance_ = 0.0;
  std::vector<double> node_groups_;
  std::vector<double> triangle_pairs_;
  std::vector<double> steps_;
};

json run_all(const Scale& scale) {
  json out = json::array();
  const auto run = [&](const std::string& name, const Mesh& mesh) {
    std::fprintf(stderr, "  %s ...\n", name.c_str());
    out.push_back(Comparison(name, mesh).run(scale));
  };
  run("bunny 69K", bunny());
  run("knot 1K", normalised(torus_knot(1'000)));
  run("knot 10K", normalised(torus_knot(10'000)));
  run("knot 70K", normalised(torus_knot(70'000)));
  for (const auto& [name, file] :
       {std::pair("cow 6K", "cow.obj"), {"fandisk 13K", "fandisk.obj"}}) {
    const char* folder = std::getenv("FIRSTCONTACT_DATA_DIR");
    if (folder == nullptr) {
      std::fprintf(stderr, "  %s skipped: needs FIRSTCONTACT_DATA_DIR\n", name);
    } else {
      run(name, normalised(read_mesh(std::filesystem::path(folder) / "meshes" / "classic" / file)));
    }
  }
  return out;
}

}  // namespace
}  // namespace firstcontact::benchmarks

int main(int argc, char** argv) {
  using namespace firstcontact::benchmarks;
  const bool quick = argc == 3 && std::string(argv[1]) == "--quick";
  if (argc != 2 && !quick) {
    std::fprintf(stderr, "usage: first_contact_benchmark [--quick] OUTPUT.json\n");
    return 2;
  }
  const Scale scale =
      quick ? Scale{.motions = 40, .continuous_collide_triangles = 150'000} : Scale{};
  std::ofstream(argv[argc - 1]) << run_all(scale).dump(2) << '\n';
  return EXIT_SUCCESS;
}
