/// @file
/// A checked scene, and its result, which is to be proven again.

#pragma once

#include <filesystem>
#include <string>

#include <firstcontact/scene/check_scene.h>
#include <firstcontact/scene/loaded_scene.h>
#include <firstcontact/scene_files/read_claims.h>
#include <firstcontact/scene_files/read_scene.h>
#include <firstcontact/scene_files/write_result.h>
#include <firstcontact/verification/verify_result.h>

namespace firstcontact::test {

/// Returns the result of a scene as in its file.
inline std::string checked(const std::string& scene, const CheckOptions& options = {},
                           const std::filesystem::path& source = "s") {
  ShapeCache cache;
  const LoadedScene loaded = load_scene(parse_scene(scene, source), cache);
  ManyBodiesWorkspace workspace;
  const SceneResult result = check_scene(loaded, workspace, options);
  WriteResultOptions writing;
  writing.all_pairs = options.all_pairs;
  return write_result(loaded, result, writing);
}

/// Returns the claims in the result of a scene.
inline ResultClaims claims_of(const std::string& scene, const CheckOptions& options = {},
                              const std::filesystem::path& source = "s") {
  return read_claims(checked(scene, options, source), "result.json");
}

}  // namespace firstcontact::test
