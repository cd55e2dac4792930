#include "command_line_number.h"

#include <charconv>
#include <cmath>
#include <system_error>

#include <fmt/core.h>

#include <firstcontact/text/read_double.h>

namespace firstcontact::app {

namespace {

/// The finite number that a text holds, and nothing beside it.
std::optional<double> finite_number(const std::string& text) {
  double value = 0.0;
  const char* const end = text.data() + text.size();
  const auto [rest, error] = detail::read_double(text.data(), end, value);
  const bool is_number = error == std::errc() && rest == end && std::isfinite(value);
  return is_number ? std::optional(value) : std::nullopt;
}

}  // namespace

CLI::Option* add_number(CLI::App& command, const std::string& name, std::optional<double>& number,
                        Range range, const std::string& description) {
  const auto take = [&number, name, range](const std::string& text) {
    const std::optional<double> value = finite_number(text);
    if (!value || !(range == Range::positive ? *value > 0.0 : *value >= 0.0)) {
      throw CLI::ValidationError(name, fmt::format("expected a number {} 0, got \"{}\"",
                                                   range == Range::positive ? ">" : ">=", text));
    }
    number = value;
  };
  return command.add_option_function<std::string>(name, take, description)->type_name("NUMBER");
}

CLI::Option* add_number_between(CLI::App& command, const std::string& name,
                                std::optional<double>& number, double least, double greatest,
                                const std::string& description) {
  const auto take = [&number, name, least, greatest](const std::string& text) {
    const std::optional<double> value = finite_number(text);
    if (!value || !(*value >= least && *value <= greatest)) {
      throw CLI::ValidationError(
          name, fmt::format("expected a number from {} to {}, got \"{}\"", least, greatest, text));
    }
    number = value;
  };
  return command.add_option_function<std::string>(name, take, description)->type_name("NUMBER");
}

namespace {

/// Adds an option that gives a whole number > 0 to `count`.
template <class Count>
CLI::Option* add_count_to(CLI::App& command, const std::string& name, Count& count,
                          const std::string& description) {
  const auto take = [&count, name](const std::string& text) {
    std::size_t number = 0;
    const char* const end = text.data() + text.size();
    const auto [rest, error] = std::from_chars(text.data(), end, number);
    if (error != std::errc() || rest != end || number == 0) {
      throw CLI::ValidationError(name,
                                 fmt::format("expected a whole number > 0, got \"{}\"", text));
    }
    count = number;
  };
  return command.add_option_function<std::string>(name, take, description)->type_name("NUMBER");
}

}  // namespace

CLI::Option* add_count(CLI::App& command, const std::string& name, std::size_t& count,
                       const std::string& description) {
  return add_count_to(command, name, count, description);
}

CLI::Option* add_count(CLI::App& command, const std::string& name,
                       std::optional<std::size_t>& count, const std::string& description) {
  return add_count_to(command, name, count, description);
}

CLI::Option* add_threads(CLI::App& command, int& threads, const std::string& same) {
  return command
      .add_option("--threads", threads,
                  "Number of threads; 0, the default, for one on each core. " + same +
                      " does not depend on it")
      ->check(CLI::Range(0, 1024))
      ->type_name("N");
}

}  // namespace firstcontact::app
