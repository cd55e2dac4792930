// Times both loops of a haptic scene in virtual time, and prints the errors of two forces. The
// reference is the force of a contact loop that runs to convergence at the same tick and pose of
// the tool. One force is the one that the hand feels, from a contact set that is 1 to 1.75 ms old.
// The other is computed from the set that this tick's cycle makes.
//
//     haptics_benchmark SCENE.json [SECONDS [SPEED [RADIUS [SEED [MOST_CONTACTS [HAND [LEAD]]]]]]]
//
// The motion of the hand is independent of the scene. The hand moves through random via points in a
// ball of RADIUS [m] around the start, with mean speeds of at most SPEED [m/s] between them. HAND
// is the stiffness of the hand [N/m]. LEAD [ms] is the time by which the targets of cycles are
// ahead. With LEAD 0 the set of a tick's own cycle shows the error that the limited number of
// rounds leaves. Times are those of the thread's CPU clock; every tick counts. Forces are compared
// where there is no friction.

#include <ctime>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <numbers>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <firstcontact/geometry/shape_bounds.h>
#include <firstcontact/haptic_devices/simulated_operator.h>
#include <firstcontact/haptic_sessions/detail/target_lead.h>
#include <firstcontact/haptic_sessions/haptic_session.h>
#include <firstcontact/haptic_sessions/timing_histogram.h>
#include <firstcontact/haptics/contact_loop.h>
#include <firstcontact/haptics/force_loop.h>
#include <firstcontact/haptics_files/haptic_setup.h>
#include <firstcontact/scene/loaded_scene.h>
#include <firstcontact/scene/shape_cache.h>
#include <firstcontact/scene_files/read_scene.h>

namespace firstcontact {
namespace {

/// [ticks]  Interval between two compared forces; successive comparisons meet a set at different
/// ages.
constexpr std::int64_t kCompared = 31;

struct Options {
  double seconds = 10.0;
  double speed = 0.5;
  double radius = 0.0;
  std::uint64_t seed = 1;
  std::size_t most_contacts = 32;
  double hand = 400.0;
  double lead = 1.375;  // [ms]  Reaches the middle of 1 to 1.75 ms, the ages of the felt sets.
};

std::int64_t cpu_ns() {
  timespec now{};
  (void)clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return std::int64_t{now.tv_sec} * 1'000'000'000 + now.tv_nsec;
}

std::unique_ptr<Device> hand_of(const Options& options, const HapticTool& tool, std::size_t k) {
  RandomPathOptions path;
  path.seed = options.seed + 100 * k;
  path.radius = options.radius > 0.0 ? options.radius : 2.0 * tool.shape.bounds().reach;
  path.fastest = options.speed;
  path.slowest = std::min(path.slowest, path.fastest);
  path.count = static_cast<std::size_t>(20.0 * options.seconds + 10.0);
  SimulatedOperatorOptions operator_options;
  operator_options.path = random_via_points(path);
  operator_options.seed = path.seed;
  operator_options.hand.stiffness = options.hand;
  return std::make_unique<SimulatedOperator>(operator_options);
}

void print(const char* what, const TimingHistogram& histogram, double unit, const char* name) {
  const auto in_unit = [&](std::int64_t x) { return static_cast<double>(x) / unit; };
  std::printf("  %-10s median %.4g, p99 %.4g, p99.9 %.4g, greatest %.4g %s of %llu\n", what,
              in_unit(histogram.quantile_ns(0.5)), in_unit(histogram.quantile_ns(0.99)),
              in_unit(histogram.quantile_ns(0.999)), in_unit(histogram.greatest_ns()), name,
              static_cast<unsigned long long>(histogram.count()));
}

struct Fidelity {
  std::vector<double> errors;  // [-]
  std::vector<double> angles;  // [deg]

  void add(const Eigen::Vector3d& felt, const Eigen::Vector3d& exact) {
    if (exact.norm() < 0.2) {  // [N]  A smaller force has no meaningful direction.
      return;
    }
    errors.push_back((felt - exact).norm() / exact.norm());
    const double cosine = felt.dot(exact) / std::max(1e-12, felt.norm() * exact.norm());
    angles.push_back(std::acos(std::clamp(cosine, -1.0, 1.0)) * 180.0 / std::numbers::pi);
  }

  void print(const char* what) const {
    std::printf(
        "  %-10s error median %.3g %%, p99 %.3g %%; direction median %.3g, p99 %.3g degrees; "
        "%zu compared\n",
        what, 100.0 * quantile(errors, 0.5), 100.0 * quantile(errors, 0.99), quantile(angles, 0.5),
        quantile(angles, 0.99), errors.size());
  }

  static double quantile(std::vector<double> values, double share) {
    if (values.empty()) {
      return 0.0;
    }
    std::sort(values.begin(), values.end());
    return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
  }
};

/// Contact loop that runs to convergence.
class Reference {
 public:
  Reference(const HapticScene& scene, const std::vector<DeviceMapping>& mappings,
            const HapticSessionOptions& session)
      : scene_(scene), forces_(scene, mappings, session.forces) {
    options_ = session.contacts;
    options_.rounds = 60;
    options_.least_gain = 0.0;
    options_.most_contacts = kMostHapticContacts;
  }

  /// Computes the force on the first tool at its present pose; none where 60 rounds do not suffice.
  ///
  /// @param from  the contact set that is felt
  std::optional<Eigen::Vector3d> force(const HapticContactSet& from, double contact_distance,
                                       const std::vector<Pose>& targets,
                                       const std::vector<DeviceState>& states, std::int64_t now) {
    for (std::size_t k = 0; k < targets.size(); ++k) {
      scene_.tools[k].X_WB = from.X_WB[k];
    }
    scene_.contact_distance = contact_distance;
    ContactLoop contacts(scene_, options_);
    const bool is_converged = contacts.advance(targets, 1e-3, now).is_converged;
    HapticContactSet set = contacts.contact_set();
    set.sequence = ++sequence_;
    const Eigen::Vector3d force = forces_.tick(now, set, states).tools[0].force_W;
    return is_converged ? std::optional(force) : std::nullopt;
  }

 private:
  HapticScene scene_;
  ContactLoopOptions options_;
  ForceLoop forces_;
  std::uint64_t sequence_ = 0;
};

int run(const std::string& file, const Options& options) {
  Scene scene = read_scene(file);
  ShapeCache cache;
  prepare_haptics(scene, cache, options.seconds);
  const HapticSetup setup = haptic_setup(load_scene(std::move(scene), cache));
  HapticSessionOptions session = setup.options;
  session.contacts.most_contacts = options.most_contacts;
  const auto mappings = complete_mappings(setup.scene, session.mappings);
  ContactLoop contacts(setup.scene, session.contacts);
  ForceLoop forces(setup.scene, mappings, session.forces);
  ForceLoop forces_at_once(setup.scene, mappings, session.forces);
  Reference reference(setup.scene, mappings, session);

  std::vector<std::unique_ptr<Device>> devices;
  for (std::size_t k = 0; k < setup.scene.tools.size(); ++k) {
    devices.push_back(hand_of(options, setup.scene.tools[k], k));
  }
  TimingHistogram tick_cpu;
  TimingHistogram cycle_cpu;
  TimingHistogram touching_cpu;
  TimingHistogram listed;
  TimingHistogram found;
  std::size_t rounds = 0;      // Sum over the cycles with contacts.
  std::size_t unfinished = 0;  // Number of cycles that ended before they converged.
  Fidelity felt;
  Fidelity at_once;
  double clearance = 1e9;
  const auto count = static_cast<std::int64_t>(options.seconds * 4000.0);
  HapticContactSet set = contacts.contact_set();
  std::vector<DeviceState> states(devices.size());
  std::vector<Pose> targets(devices.size());
  std::vector<Pose> led(devices.size());
  std::vector<detail::TargetLead> leads(mappings.begin(), mappings.end());
  for (std::int64_t k = 0; k < count; ++k) {
    const std::int64_t now = 250'000 * k;
    for (std::size_t d = 0; d < devices.size(); ++d) {
      states[d] = devices[d]->read(now);
    }
    if (k % 4 == 0) {
      set = contacts.contact_set();  // The set of the cycle before, so a millisecond of latency.
    }
    const std::int64_t before = cpu_ns();
    const ForceTick& tick = forces.tick(now, set, states);
    tick_cpu.add(cpu_ns() - before);
    listed.add(tick.contacts);
    for (std::size_t d = 0; d < devices.size(); ++d) {
      devices[d]->command(tick.tools[d].command, now);
      targets[d] = tick.tools[d].target;
      leads[d].watch(now, tick.tools[d]);
      led[d] = leads[d].target_in(detail::is_rubbing(set, d) ? 0.0 : 1e-3 * options.lead);
    }
    std::optional<Eigen::Vector3d> exact;
    if (k % kCompared == 0) {  // Starts at tick 0, as the ramp of the reference has to end.
      exact = reference.force(set, contacts.contact_distance(), targets, states, now);
    }
    exact = k > 1000 ? exact : std::nullopt;
    if (exact) {
      felt.add(tick.tools[0].force_W, *exact);
    }
    if (k % 4 == 0) {
      const std::int64_t begin = cpu_ns();
      const HapticCycle& cycle = contacts.advance(led, 1e-3, now);
      const std::int64_t took = cpu_ns() - begin;
      cycle_cpu.add(took);
      if (cycle.contacts > 0) {
        touching_cpu.add(took);
      }
      found.add(static_cast<std::int64_t>(cycle.contacts));
      rounds += cycle.contacts > 0 ? cycle.rounds : 0;
      if (k % kCompared == 0) {
        const ForceTick& own = forces_at_once.tick(now, contacts.contact_set(), states);
        if (exact) {
          at_once.add(own.tools[0].force_W, *exact);
        }
      }
      unfinished += cycle.is_converged ? 0 : 1;
      clearance = std::min(clearance, cycle.clearance);
    }
  }
  std::printf("%s: %g s, speed %g m/s, at most %zu contacts listed\n", file.c_str(),
              options.seconds, options.speed, options.most_contacts);
  print("tick", tick_cpu, 1e3, "us");
  print("cycle", cycle_cpu, 1e3, "us");
  print("touching", touching_cpu, 1e3, "us, of cycles with contacts,");
  print("listed", listed, 1.0, "contacts");
  print("found", found, 1.0, "contacts");
  std::printf("  rounds     %.3g in the mean of cycles with contacts; %zu cycles unfinished\n",
              static_cast<double>(rounds) /
                  static_cast<double>(std::max<std::uint64_t>(1, touching_cpu.count())),
              unfinished);
  std::printf("  apart      %.4g um at least (proven)\n", 1e6 * clearance);
  felt.print("force");
  at_once.print("at once");
  return 0;
}

}  // namespace
}  // namespace firstcontact

int main(int argc, char** argv) {
  if (argc < 2) {
    std::fprintf(stderr,
                 "haptics_benchmark SCENE.json [SECONDS [SPEED [RADIUS [SEED [MOST_CONTACTS "
                 "[HAND [LEAD]]]]]]]\n");
    return 2;
  }
  firstcontact::Options options;
  const auto number = [&](int at, double otherwise) {
    return argc > at ? std::atof(argv[at]) : otherwise;
  };
  options.seconds = number(2, options.seconds);
  options.speed = number(3, options.speed);
  options.radius = number(4, options.radius);
  options.seed = static_cast<std::uint64_t>(number(5, 1.0));
  options.most_contacts = static_cast<std::size_t>(number(6, 32.0));
  options.hand = number(7, options.hand);
  options.lead = number(8, options.lead);
  return firstcontact::run(argv[1], options);
}
