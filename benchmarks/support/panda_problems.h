/// @file
/// MotionBenchMaker's problems of the Panda, in FIRSTCONTACT_DATA_DIR.

#pragma once

#include <cstdio>
#include <filesystem>
#include <string>

#include <firstcontact/scene_files/robot_question.h>

namespace firstcontact::benchmarks {

inline constexpr const char* kPandaFamilies[] = {"bookshelf_small_panda", "box_panda", "cage_panda",
                                                 "table_pick_panda"};
inline constexpr int kPandaProblems = 100;  // Number of problems in each family, from 1 on.

inline RobotQuestion panda_problem(const std::filesystem::path& data, const std::string& family,
                                   int problem) {
  const std::filesystem::path panda = data / "robots/moveit_resources_panda_description";
  char number[5];
  std::snprintf(number, sizeof number, "%04d", problem);
  const std::filesystem::path folder = data / "planning_mbm/panda" / family;
  RobotQuestion question;
  question.robot = {panda / "urdf/panda.urdf", {data / "robots"}};
  question.srdf = panda / "srdf/panda.srdf";
  question.request = folder / ("request" + std::string(number) + ".yaml");
  question.environment = {folder / ("scene" + std::string(number) + ".yaml")};
  return question;
}

}  // namespace firstcontact::benchmarks
