#include <firstcontact/planning/detail/plan_range.h>

#include <firstcontact/math/random_numbers.h>

namespace firstcontact::detail {
namespace {

constexpr double kShareOfRange = 0.2;  // [-]  Part of the mean distance of samples.
constexpr int kSamplesOfRange = 64;

}  // namespace

double default_range(const ConfigurationSpace& space) {
  RandomNumbers random(0);
  double sum = 0.0;
  for (int k = 0; k < kSamplesOfRange; ++k) {
    const Configuration from = space.sample(random);
    sum += space.distance(from, space.sample(random));
  }
  return kShareOfRange * sum / kSamplesOfRange;
}

}  // namespace firstcontact::detail
