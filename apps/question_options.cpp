#include "question_options.h"

#include "command_line_number.h"

namespace firstcontact::app {

void add_question_options(CLI::App& command, Question& question) {
  add_number(command, "--margin", question.margin, Range::not_negative,
             "[m] Closer than this counts as contact; in place of the scene's");
  add_number(
      command, "--tolerance", question.tolerance, Range::positive,
      "[m] A reported contact is no farther than margin + tolerance; in place of the scene's");
  add_number(command, "--deadline", question.deadline, Range::positive,
             "[s] For each scene; then its answer is undecided");
  command.add_flag("--lenient", question.lenient,
                   "Names in files that nobody knows are warnings, not errors, even where they "
                   "could hold geometry");
  command.add_flag("--closest", question.closest, "Also the closest approach over the whole step");
  command.add_flag("--all-pairs", question.all_pairs, "Also the answer of every pair of bodies");
}

}  // namespace firstcontact::app
