#include <firstcontact/haptics/contact_set.h>

#include <bit>

namespace firstcontact {
namespace {

/// Mixes words one after another (the finaliser of splitmix64).
class WordMixer {
 public:
  void add(std::uint64_t word) noexcept {
    state_ = (state_ ^ word) + 0x9e3779b97f4a7c15U;
    state_ = (state_ ^ (state_ >> 30)) * 0xbf58476d1ce4e5b9U;
    state_ ^= state_ >> 27;
  }
  void add(double number) noexcept { add(std::bit_cast<std::uint64_t>(number)); }
  void add(const Eigen::Vector3d& vector) noexcept {
    for (int k = 0; k < 3; ++k) {
      add(vector[k]);
    }
  }
  [[nodiscard]] std::uint64_t take() const noexcept { return state_; }

 private:
  std::uint64_t state_ = 0;
};

std::uint64_t word_of(std::int32_t number) noexcept {
  return static_cast<std::uint64_t>(static_cast<std::uint32_t>(number));
}

}  // namespace

std::uint64_t checksum_of(const HapticContactSet& set) noexcept {
  WordMixer mixer;
  mixer.add(set.sequence);
  mixer.add(static_cast<std::uint64_t>(set.stamp_ns));
  mixer.add(static_cast<std::uint64_t>(set.lasted_ns));
  mixer.add((std::uint64_t{set.tools} << 32) | set.count);
  mixer.add(std::uint64_t{set.full_count});
  mixer.add(set.angle);
  mixer.add(std::uint64_t{set.is_unproven});
  for (std::size_t k = 0; k < kMostTools; ++k) {
    mixer.add(set.X_WB[k].position);
    const Eigen::Quaterniond& q = set.X_WB[k].rotation;
    mixer.add(q.w());
    mixer.add(Eigen::Vector3d(q.vec()));
    mixer.add(set.p_WC[k]);
  }
  for (std::size_t k = 0; k < set.count && k < kMostHapticContacts; ++k) {
    const HapticContact& contact = set.contacts[k];
    mixer.add(word_of(contact.tool));
    mixer.add(word_of(contact.other));
    mixer.add(word_of(contact.body));
    mixer.add(contact.point);
    mixer.add(contact.normal);
    mixer.add(contact.gap);
    mixer.add(contact.way);
    mixer.add(contact.friction);
    mixer.add(contact.surface_velocity);
    mixer.add(std::uint64_t{contact.slides});
    mixer.add((word_of(contact.link) << 32) | word_of(contact.other_link));
  }
  mixer.add((std::uint64_t{set.joint_count} << 32) | set.link_count);
  for (std::size_t k = 0; k < set.joint_count && k < kMostHapticJoints; ++k) {
    mixer.add(set.joints[k]);
  }
  for (std::size_t k = 0; k < set.link_count && k < kMostHapticLinks; ++k) {
    mixer.add(set.axes[k].point);
    mixer.add(set.axes[k].direction);
  }
  return mixer.take();
}

}  // namespace firstcontact
