#include "question_options.h"

#include <charconv>
#include <cstddef>
#include <system_error>

#include <fmt/core.h>

#include "command_line_number.h"

namespace firstcontact::app {
namespace {

ContactState parse_contacts(const std::string& text) {
  for (const ContactState& contacts :
       {ContactState::none, ContactState::first, ContactState::all}) {
    if (text == contacts_text(contacts)) {
      return contacts;
    }
  }
  std::size_t most = 0;
  const char* const end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, most);
  if (error != std::errc() || rest != end || most == 0) {
    throw CLI::ValidationError(
        "--contacts",
        fmt::format("expected none, first, all or a whole number > 0, got \"{}\"", text));
  }
  return ContactState::nearest(most);
}

}  // namespace

std::string contacts_text(const ContactState& contacts) {
  switch (contacts.kind) {
    case ContactState::Kind::none:
      return "none";
    case ContactState::Kind::first:
      return "first";
    case ContactState::Kind::nearest:
      return std::to_string(contacts.most);
    case ContactState::Kind::all:
      break;
  }
  return "all";
}

void add_question_options(CLI::App& command, Question& question) {
  add_number(command, "--margin", question.margin, Range::not_negative,
             "[m] Bodies closer than this are in contact; replaces the scene's margin");
  add_number(command, "--tolerance", question.tolerance, Range::positive,
             "[m] A reported contact is no farther than margin + tolerance; replaces the scene's");
  add_number(command, "--deadline", question.deadline, Range::positive,
             "[s] Time limit of each scene; an answer that takes longer is undecided");
  command.add_flag("--lenient", question.lenient,
                   "Unknown names in files are warnings, not errors, even where they "
                   "could hold geometry");
  command
      .add_option_function<std::string>(
          "--contacts",
          [&question](const std::string& text) { question.contacts = parse_contacts(text); },
          fmt::format(
              "Number of feature pairs that are listed for two bodies in contact: none, the "
              "first, all, or at most N, the nearest ones and some of each region; "
              "replaces the scene's ({})",
              ContactState::kUsual))
      ->type_name("none|first|all|N");
  command.add_flag("--closest", question.closest, "Adds the closest approach over the whole step");
  command.add_flag("--all-pairs", question.all_pairs, "Adds the answer for each pair of bodies");
  command.add_flag("--all-contacts-in-time", question.all_contacts_in_time,
                   "Adds the intervals of time in which each pair is in contact");
}

}  // namespace firstcontact::app
