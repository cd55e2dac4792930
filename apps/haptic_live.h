/// @file
/// The live view of a haptic session: its page, and the messages for it.

#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <firstcontact/haptics/contact_loop.h>
#include <firstcontact/haptics/force_loop.h>
#include <firstcontact/haptics_files/haptic_setup.h>
#include <firstcontact/record/run.h>

namespace firstcontact::app {

/// Collects the data of the view: poses, devices, contacts and forces of all tools.
class HapticLive {
 public:
  /// @param setup  lives as long as this object
  /// @param mouse  the number of the tool that follows the mouse of the page, if any
  HapticLive(const HapticSetup& setup, std::optional<std::size_t> mouse);

  /// The viewer's page, with bodies at rest until messages move them.
  [[nodiscard]] std::string page(const RunHeader& header, std::string_view page_template) const;

  void take(const HapticCycle& cycle);

  /// Whether a picture is due at a tick.
  [[nodiscard]] bool is_due(const ForceTick& tick) const;

  /// A picture as JSON.
  ///
  /// @param devices  of the tick, as a run has them
  [[nodiscard]] std::string picture(const ForceTick& tick, const std::vector<RunDevice>& devices);

 private:
  [[nodiscard]] std::vector<std::size_t> links(std::size_t tool) const;
  [[nodiscard]] std::string tools_json() const;
  [[nodiscard]] std::string mouse_json(const ForceTick& tick) const;

  const HapticSetup& setup_;
  std::optional<std::size_t> mouse_;
  std::vector<std::optional<Pose>> poses_;  // X_WB of tools, and of members that move.
  std::size_t first_link_ = 0;              // Index of the first link among the members.
  std::vector<HapticTouch> touches_;
  std::int64_t shown_ns_ = 0;
};

}  // namespace firstcontact::app
