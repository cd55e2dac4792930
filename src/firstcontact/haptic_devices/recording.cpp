#include <firstcontact/haptic_devices/recording.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <span>
#include <system_error>
#include <utility>

#include <firstcontact/haptic_devices/detail/quiet_state.h>
#include <firstcontact/haptic_devices/detail/recording_head.h>
#include <firstcontact/text/ascii.h>
#include <firstcontact/text/json_reader.h>
#include <firstcontact/text/parse_error.h>
#include <firstcontact/text/read_file.h>
#include <firstcontact/text/text_cursor.h>
#include <firstcontact/text/write_json.h>

namespace firstcontact {
namespace {

using detail::quoted;
using detail::trimmed;

enum class Column {
  time_ns,
  sequence,
  buttons,
  status,
  x,
  y,
  z,
  qw,
  qx,
  qy,
  qz,
  vx,
  vy,
  vz,
  wx,
  wy,
  wz,
  other,  ///< A column of another program: its name has a dot.
};
constexpr std::size_t kColumns = static_cast<std::size_t>(Column::other);
constexpr std::array<std::string_view, kColumns> kColumnNames{
    "time_ns", "sequence", "buttons", "status", "x",  "y",  "z",  "qw", "qx",
    "qy",      "qz",       "vx",      "vy",     "vz", "wx", "wy", "wz"};

constexpr std::string_view kGrip = "grip";

/// Finds the number of a column "grip0" to "grip15"; none for another name.
std::optional<std::size_t> grip_of(std::string_view name) {
  for (std::size_t k = 0; k < kMostGrips; ++k) {
    if (name == std::string(kGrip) + std::to_string(k)) {
      return k;
    }
  }
  return std::nullopt;
}

std::string_view name_of(Column column) { return kColumnNames[static_cast<std::size_t>(column)]; }

/// Whether recordings of this kind must have the column.
bool is_needed(Column column, DeviceKind kind) {
  if (column <= Column::sequence) {
    return true;
  }
  const bool of_pose = column >= Column::x && column <= Column::qz;
  const bool of_rate = column >= Column::vx && column <= Column::wz;
  return kind == DeviceKind::pose ? of_pose : of_rate;
}

/// Numbers of buttons: the most that samples can have, and the number for a head that states none.
constexpr int kMostButtons = 32;
constexpr int kUnstated = -1;

/// A key whose value limits commands along driven axes.
struct LimitKey {
  std::string_view name;
  double DeviceCapabilities::*value;
  bool is_angular = false;
};

constexpr std::array<LimitKey, 6> kLimitKeys{{
    {"max_force", &DeviceCapabilities::max_force},
    {"max_stiffness", &DeviceCapabilities::max_stiffness},
    {"max_damping", &DeviceCapabilities::max_damping},
    {"max_torque", &DeviceCapabilities::max_torque, true},
    {"max_angular_stiffness", &DeviceCapabilities::max_angular_stiffness, true},
    {"max_angular_damping", &DeviceCapabilities::max_angular_damping, true},
}};

class RecordingParser {
 public:
  RecordingParser(std::string_view text, std::string source)
      : rest_(detail::without_byte_order_mark(text)), source_(std::move(source)) {}

  Recording parse() {
    recording_.capabilities.buttons = kUnstated;
    read_title();
    while (next_line()) {
      if (line_.starts_with("##")) {
        continue;
      }
      if (line_.starts_with('#')) {
        read_key();
      } else if (columns_.empty()) {
        read_columns();
      } else {
        read_sample();
      }
    }
    if (columns_.empty()) {
      throw ParseError(source_, "expected a line of column names, as 'time_ns,sequence,x,...'");
    }
    if (recording_.samples.empty()) {
      throw ParseError(source_, "expected at least one sample below the column names");
    }
    free_unstated_limits();
    return std::move(recording_);
  }

 private:
  /// Makes the limits of driven axes infinite where the head states none.
  void free_unstated_limits() {
    DeviceCapabilities& device = recording_.capabilities;
    for (const LimitKey& key : kLimitKeys) {
      const std::array<bool, 3>& driven =
          key.is_angular ? device.driven.angular : device.driven.linear;
      if (std::ranges::find(driven, true) != driven.end() &&
          std::ranges::find(keys_, key.name) == keys_.end()) {
        device.*key.value = std::numeric_limits<double>::infinity();
      }
    }
  }

  [[noreturn]] void fail(const std::string& message) const {
    throw ParseError(source_, number_, message);
  }

  [[noreturn]] void fail_at(std::size_t place, const std::string& message) const {
    fail("column " + std::to_string(place + 1) + " (" + std::string(names_[place]) +
         "): " + message);
  }

  /// Goes to the next line that is not empty.
  bool next_line() {
    do {
      if (rest_.empty()) {
        return false;
      }
      const std::size_t end = rest_.find('\n');
      line_ = trimmed(rest_.substr(0, end));
      rest_.remove_prefix(end == std::string_view::npos ? rest_.size() : end + 1);
      ++number_;
    } while (line_.empty());
    return true;
  }

  void read_title() {
    std::string_view title = next_line() && line_.starts_with('#') ? trimmed(line_.substr(1)) : "";
    if (!title.starts_with(detail::kRecordingTitle)) {
      throw ParseError(source_, std::max<std::size_t>(number_, 1),
                       "expected '# firstcontact recording: 1' on the first line");
    }
    title.remove_prefix(detail::kRecordingTitle.size());
    if (title.starts_with(':')) {
      title.remove_prefix(1);
    }
    if (trimmed(title) != "1") {
      fail("expected version 1 of the format, got " + quoted(trimmed(title)));
    }
  }

  void read_key() {
    if (!columns_.empty()) {
      fail("keys stand before the column names; a comment begins with two signs ##");
    }
    const std::string_view line = trimmed(line_.substr(1));
    detail::read_recording_key(line, source_, number_, recording_);
    const std::string_view key = trimmed(line.substr(0, line.find(':')));
    if (std::ranges::find(keys_, key) != keys_.end()) {
      fail("the key " + quoted(key) + " stands twice");
    }
    keys_.push_back(key);
  }

  /// Splits the line at its commas.
  void split(std::vector<std::string_view>& cells) const {
    cells.clear();
    std::string_view rest = line_;
    while (true) {
      const std::size_t comma = rest.find(',');
      cells.push_back(trimmed(rest.substr(0, comma)));
      if (comma == std::string_view::npos) {
        return;
      }
      rest.remove_prefix(comma + 1);
    }
  }

  /// Refuses a line that a spreadsheet has written with semicolons.
  void require_commas() const {
    if (line_.find(',') == std::string_view::npos && line_.find(';') != std::string_view::npos) {
      fail("columns are separated by commas, but this line has semicolons; numbers have a point");
    }
  }

  void read_columns() {
    require_commas();
    split(names_);
    for (std::size_t place = 0; place < names_.size(); ++place) {
      const std::string_view name = names_[place];
      const auto found = std::find(kColumnNames.begin(), kColumnNames.end(), name);
      const auto column = static_cast<Column>(found - kColumnNames.begin());
      grips_.push_back(grip_of(name));
      if (grips_.back()) {
        take_grip(place);
      } else if (column == Column::other && name.starts_with(kGrip)) {
        fail_at(place, "unknown column; grips have the names grip0 to grip" +
                           std::to_string(kMostGrips - 1));
      } else if (column == Column::other && name.find('.') == std::string_view::npos) {
        const std::string_view nearest =
            detail::nearest_word(name, {kColumnNames.begin(), kColumnNames.end()});
        fail_at(place, "unknown column" + (nearest.empty()
                                               ? std::string("; names of other programs have a dot")
                                               : "; is it " + quoted(nearest) + "?"));
      }
      if (column != Column::other &&
          std::find(columns_.begin(), columns_.end(), column) != columns_.end()) {
        fail_at(place, "stands twice");
      }
      columns_.push_back(column);
    }
    count_buttons();
    for (std::size_t k = 0; k < static_cast<std::size_t>(recording_.capabilities.grips); ++k) {
      if (std::ranges::find(grips_, std::optional(k)) == grips_.end()) {
        fail("column 'grip" + std::to_string(k) + "' is missing: grips count from grip0 on");
      }
    }
    for (std::size_t i = 0; i < kColumns; ++i) {
      const auto column = static_cast<Column>(i);
      if (is_needed(column, recording_.capabilities.kind) &&
          std::find(columns_.begin(), columns_.end(), column) == columns_.end()) {
        fail("column '" + std::string(name_of(column)) + "' is missing, which recordings of kind " +
             kDeviceKindWords[static_cast<std::size_t>(recording_.capabilities.kind)] + " have");
      }
    }
  }

  /// Counts the buttons. Without their column none is ever pressed; without their key there may be
  /// any.
  void count_buttons() {
    int& buttons = recording_.capabilities.buttons;
    if (std::ranges::find(columns_, Column::buttons) == columns_.end()) {
      buttons = 0;
    } else if (buttons == kUnstated) {
      buttons = kMostButtons;
    }
  }

  void take_grip(std::size_t place) {
    if (std::count(grips_.begin(), grips_.end(), grips_.back()) > 1) {
      fail_at(place, "stands twice");
    }
    int& grips = recording_.capabilities.grips;
    grips = std::max(grips, static_cast<int>(*grips_.back()) + 1);
  }

  template <class Integer>
  [[nodiscard]] Integer integer(std::size_t place, const char* what) const {
    Integer value{};
    const std::string_view cell = cells_[place];
    const char* end = cell.data() + cell.size();
    const auto [stop, error] = std::from_chars(cell.data(), end, value);
    if (error != std::errc() || stop != end) {
      fail_at(place, std::string("expected ") + what + ", got " + quoted(cell));
    }
    return value;
  }

  [[nodiscard]] double number(std::size_t place) const {
    const double value = detail::number_or_nan(cells_[place]);
    if (!(std::abs(value) <= 1e6)) {
      fail_at(place, "expected a number of at most 1e6, got " + quoted(cells_[place]));
    }
    return value;
  }

  [[nodiscard]] DeviceStatus status(std::size_t place) const {
    for (std::size_t i = 0; i < kDeviceStatusWords.size(); ++i) {
      if (cells_[place] == kDeviceStatusWords[i]) {
        return static_cast<DeviceStatus>(i);
      }
    }
    fail_at(place, "expected waiting, live, silent, lost or ended, got " + quoted(cells_[place]));
  }

  void read_cell(std::size_t place, DeviceState& sample) {
    const Column column = columns_[place];
    switch (column) {
      case Column::time_ns:
        sample.time_ns = integer<std::int64_t>(place, "a whole number of nanoseconds");
        return;
      case Column::sequence:
        sample.sequence = integer<std::uint64_t>(place, "a whole number >= 0");
        return;
      case Column::buttons:
        sample.buttons = integer<std::uint32_t>(place, "the bits of the buttons, a whole number");
        return;
      case Column::status:
        sample.status = status(place);
        return;
      case Column::other:
        if (grips_[place]) {
          sample.grips[*grips_[place]] = number(place);
        }
        return;
      default:
        break;
    }
    const double value = number(place);
    const auto offset = [&](Column first) {
      return static_cast<Eigen::Index>(column) - static_cast<Eigen::Index>(first);
    };
    if (column < Column::qw) {
      sample.X_DH.position[offset(Column::x)] = value;
    } else if (column < Column::vx) {
      // Eigen stores x, y, z, w.
      sample.X_DH.rotation.coeffs()[(offset(Column::qw) + 3) % 4] = value;
    } else if (column < Column::wx) {
      sample.linear_rate[offset(Column::vx)] = value;
    } else {
      sample.angular_rate[offset(Column::wx)] = value;
    }
  }

  void read_sample() {
    require_commas();
    split(cells_);
    if (cells_.size() != columns_.size()) {
      fail("expected " + std::to_string(columns_.size()) + " cells as in the line of names, got " +
           std::to_string(cells_.size()));
    }
    DeviceState sample;
    sample.status = DeviceStatus::live;
    for (std::size_t place = 0; place < cells_.size(); ++place) {
      read_cell(place, sample);
    }
    require_sense(sample);
    check_order(sample);
    recording_.samples.push_back(sample);
  }

  void require_sense(const DeviceState& sample) const {
    require_length(sample.X_DH.position, "a position x, y, z", "m");
    require_length(sample.linear_rate, "a rate vx, vy, vz", "m/s");
    require_length(sample.angular_rate, "a rate wx, wy, wz", "rad/s");
    if (!detail::makes_sense(sample)) {
      fail("expected a quaternion qw, qx, qy, qz of length 1, got one of length " +
           detail::write_json(sample.X_DH.rotation.norm()) + "; divide it by its length");
    }
  }

  /// Requires a bound of a length. Each of the three numbers may be within it, and the length
  /// beyond it.
  void require_length(const Eigen::Vector3d& vector, const char* what, const char* unit) const {
    if (!(vector.norm() <= detail::kMostOfSample)) {
      fail(std::string("expected ") + what + " of at most 1e6 " + unit + " in length, got " +
           detail::write_json(vector.norm()) + "; give it in SI units");
    }
  }

  void check_order(const DeviceState& sample) const {
    if (recording_.samples.empty()) {
      return;
    }
    const DeviceState& last = recording_.samples.back();
    if (sample.time_ns < last.time_ns) {
      fail("time_ns " + std::to_string(sample.time_ns) + " is before that of the line above, " +
           std::to_string(last.time_ns) + "; sort the lines by time");
    }
    if (sample.sequence < last.sequence) {
      fail("sequence " + std::to_string(sample.sequence) +
           " is less than that of the line above, " + std::to_string(last.sequence) +
           "; give each connection numbers that go on");
    }
  }

  std::string_view rest_;
  std::string source_;
  std::string_view line_;
  std::size_t number_ = 0;
  std::vector<std::string_view> names_;
  std::vector<Column> columns_;
  std::vector<std::optional<std::size_t>> grips_;  // For each column the number of its grip.
  std::vector<std::string_view> cells_;
  std::vector<std::string_view> keys_;
  Recording recording_;
};

void append(std::string& text, const Eigen::Vector3d& vector) {
  for (const double number : vector) {
    text += ',' + detail::write_json(number);
  }
}

}  // namespace

Recording parse_recording(std::string_view text, const std::filesystem::path& source) {
  return RecordingParser(text, source.string()).parse();
}

Recording read_recording(const std::filesystem::path& path) {
  return parse_recording(detail::read_file(path, "a recording of a device"), path);
}

std::string recording_head(const DeviceCapabilities& capabilities,
                           const DeviceCalibration& calibration) {
  std::string text = "# " + std::string(detail::kRecordingTitle) + ": 1\n" +
                     detail::recording_keys(capabilities, calibration);
  text += capabilities.kind == DeviceKind::pose
              ? "time_ns,sequence,buttons,status,x,y,z,qw,qx,qy,qz,vx,vy,vz,wx,wy,wz"
              : "time_ns,sequence,buttons,status,vx,vy,vz,wx,wy,wz";
  for (int k = 0; k < capabilities.grips; ++k) {
    text += "," + std::string(kGrip) + std::to_string(k);
  }
  return text + "\n";
}

std::string recording_line(const DeviceState& sample, DeviceKind kind, int grips) {
  std::string text = std::to_string(sample.time_ns) + "," + std::to_string(sample.sequence) + "," +
                     std::to_string(sample.buttons) + "," +
                     kDeviceStatusWords[static_cast<std::size_t>(sample.status)];
  if (kind == DeviceKind::pose) {
    const Eigen::Quaterniond& q = sample.X_DH.rotation;
    append(text, sample.X_DH.position);
    text += "," + detail::write_json(q.w());
    append(text, q.vec());
  }
  append(text, sample.linear_rate);
  append(text, sample.angular_rate);
  for (std::size_t k = 0; k < std::min(kMostGrips, static_cast<std::size_t>(std::max(0, grips)));
       ++k) {
    text += "," + detail::write_json(sample.grips[k]);
  }
  return text + "\n";
}

std::string write_recording(const Recording& recording) {
  std::string text = recording_head(recording.capabilities, recording.calibration);
  for (const DeviceState& sample : recording.samples) {
    text += recording_line(sample, recording.capabilities.kind, recording.capabilities.grips);
  }
  return text;
}

DeviceState calibrated(const DeviceState& sample, const DeviceCalibration& calibration) noexcept {
  constexpr double kUnit = 4.0 * std::numeric_limits<double>::epsilon();
  if (calibration.scale == 1.0 && calibration.X_DR.position.isZero(0.0) &&
      calibration.X_DR.rotation.coeffs() == Eigen::Quaterniond::Identity().coeffs() &&
      std::abs(sample.X_DH.rotation.squaredNorm() - 1.0) <= kUnit) {
    return sample;
  }
  const Eigen::Quaterniond R_DR = calibration.X_DR.rotation.normalized();
  DeviceState result = sample;
  result.X_DH.position =
      calibration.X_DR.position + R_DR * (calibration.scale * sample.X_DH.position);
  result.X_DH.rotation = (R_DR * sample.X_DH.rotation).normalized();
  result.linear_rate = R_DR * (calibration.scale * sample.linear_rate);
  result.angular_rate = R_DR * sample.angular_rate;
  return result;
}

}  // namespace firstcontact
