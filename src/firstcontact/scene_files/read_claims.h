/// @file
/// Reads back what a result claims, for a second proof.

#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <firstcontact/math/export.h>
#include <firstcontact/query/outcome.h>
#include <firstcontact/scene/scene.h>

namespace firstcontact {

/// The answer of one pair of members, by their names.
struct PairClaim {
  std::array<std::string, 2> pair;
  Verdict verdict = Verdict::undecided;
  double t = 0.0;               ///< [-]  Time before which the pair is claimed to be free.
  double tolerance_used = 0.0;  ///< [m]
  double margin = 0.0;          ///< [m]
  double time = 0.0;            ///< [s]
  double clearance = 0.0;       ///< [m]  Infinite where the pair is never tested.
};

/// The claims of the result of a scene.
struct ResultClaims {
  /// The scene of the result. Its paths are as they were opened.
  ///
  /// Its text_digest is that of the checked text, and empty in results that do not state it.
  Scene scene;
  std::string version;
  std::string input_digest;  ///< SHA-256 of everything that was read.
  /// Whether the scene in the result is the one that was checked, by its digest; none in results
  /// without a digest.
  std::optional<bool> has_own_scene = {};
  Verdict verdict = Verdict::undecided;
  double t = 0.0;                                       ///< [-]
  double time = 0.0;                                    ///< [s]
  std::optional<std::array<std::string, 2>> pair = {};  ///< The pair that determines t.
  double clearance = 0.0;                               ///< [m]  Infinite where no pair is tested.
  double tolerance_used = 0.0;  ///< [m]  Tolerance that the result states, else that of the scene.
  std::size_t tested = 0;       ///< Number of pairs.
  std::optional<std::vector<PairClaim>> pairs = {};  ///< The answer of every pair, where it was
                                                     ///< asked for.
};

/// Reads the claims of a result.
///
/// @param result  one JSON object, as write_result writes it
/// @param source  the file of the result, named in errors
/// @param line    the line of that file
/// @throws ParseError if it is no result, or its scene is no scene
[[nodiscard]] FIRSTCONTACT_API ResultClaims read_claims(std::string_view result,
                                                        const std::filesystem::path& source,
                                                        std::size_t line = 1,
                                                        const ReadingOptions& options = {});

}  // namespace firstcontact
