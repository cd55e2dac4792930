#include <array>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

#include <firstcontact/geometry/shape.h>
#include <firstcontact/motion/motion.h>
#include <firstcontact/query/contact.h>
#include <firstcontact/query/verdict_words.h>
#include <firstcontact/robot/coordinate_path.h>
#include <firstcontact/robot/limit_report.h>
#include <firstcontact/robot/robot_description.h>
#include <firstcontact/robot_files/read_urdf.h>
#include <firstcontact/scene/contact_pair.h>
#include <firstcontact/scene/pair_counts.h>
#include <firstcontact/verification/verify_run.h>

namespace firstcontact {
namespace {

/// One table, and where its words stand again; empty where they do not.
struct WordTable {
  std::string name;                    // Name of the Python enumeration.
  std::span<const char* const> words;  // Words in C++.
  std::vector<std::string> schemas = {};
  std::vector<std::string> scripts = {};
  bool is_in_python = true;
};

const std::string kSceneSchema = "src/firstcontact/scene_files/schema/scene.json";
const std::string kPathSchema = "src/firstcontact/scene_files/schema/path.json";
const std::string kResultSchema = "src/firstcontact/scene_files/schema/result.json";
const std::string kRunSchema = "src/firstcontact/record/schema/run.json";

std::vector<WordTable> word_tables() {
  return {
      {"Verdict", kVerdictWords, {kResultSchema}, {"viewer/src/data/result.ts"}},
      {"UndecidedReason", kUndecidedReasonWords},
      {"StartContacts", kStartContactsWords, {kSceneSchema}},
      {"ContactState", kContactStateWords, {kSceneSchema}},
      {"FeatureType",
       kFeatureTypeWords,
       {kResultSchema, kRunSchema},
       {"viewer/src/data/result.ts"}},
      {"Between", kBetweenWords, {kSceneSchema}, {"viewer/src/data/result.ts"}},
      {"Filling", kFillingWords},
      {"JointType", kJointTypeWords, {}, {"viewer/src/data/robot_data.ts"}},
      {"JointLimit", kJointLimitWords, {kResultSchema}},
      {"Turning", kTurningWords, {kSceneSchema, kResultSchema}},
      {"ProofVerdict", kProofVerdictWords},
      {"RobotSurface", kRobotSurfaceWords, {kSceneSchema}, {}, false},
      {"ContactPolicy", kContactPolicyWords, {kSceneSchema, kPathSchema}, {}, false},
      {"PathEnd", kPathEndWords, {kSceneSchema, kPathSchema}, {}, false},
      {"WhyUntested", kWhyUntestedWords, {kResultSchema}, {"viewer/src/data/reports.ts"}, false},
  };
}

std::string text_of(const std::filesystem::path& file) {
  std::ifstream stream(std::filesystem::path(FIRSTCONTACT_SOURCE_DIR) / file);
  return {std::istreambuf_iterator<char>(stream), {}};
}

/// "free", "contact" with this between them.
std::string joined(std::span<const char* const> words, std::string_view between) {
  std::string text;
  for (const char* word : words) {
    text += (text.empty() ? "" : std::string(between)) + '"' + word + '"';
  }
  return text;
}

/// The words of an enumeration of firstcontact/_words.py, in order.
std::vector<std::string> python_words(const std::string& source, const std::string& name) {
  std::vector<std::string> words;
  const std::size_t begin = source.find("class " + name + "(enum.StrEnum):");
  const std::size_t end = source.find("\nclass ", begin);
  const std::string body = begin == std::string::npos ? "" : source.substr(begin, end - begin);
  for (std::size_t at = body.find(" = \""); at != std::string::npos;
       at = body.find(" = \"", at + 1)) {
    words.push_back(body.substr(at + 4, body.find('"', at + 4) - at - 4));
  }
  return words;
}

TEST(EnumerationWords, OfSchemasAreThoseOfTheLibrary) {
  for (const WordTable& table : word_tables()) {
    for (const std::string& schema : table.schemas) {
      EXPECT_NE(text_of(schema).find("\"enum\": [" + joined(table.words, ", ") + "]"),
                std::string::npos)
          << table.name << " in " << schema;
    }
  }
  // No reason is null there.
  const auto reasons = std::span<const char* const>(kUndecidedReasonWords).subspan(1);
  EXPECT_NE(text_of(kResultSchema).find("\"enum\": [null, " + joined(reasons, ", ") + "]"),
            std::string::npos);
}

TEST(EnumerationWords, OfThePageAreThoseOfTheLibrary) {
  for (const WordTable& table : word_tables()) {
    for (const std::string& script : table.scripts) {
      EXPECT_NE(text_of(script).find(joined(table.words, " | ") + ";"), std::string::npos)
          << table.name << " in " << script;
    }
  }
}

TEST(EnumerationWords, OfPythonAreThoseOfTheLibrary) {
  const std::string source = text_of("bindings/python/firstcontact/_words.py");
  for (const WordTable& table : word_tables()) {
    if (table.is_in_python) {
      const std::vector<std::string> words(table.words.begin(), table.words.end());
      EXPECT_EQ(python_words(source, table.name), words) << table.name;
    }
  }
}

TEST(EnumerationWords, BelongToTheirEnumerators) {
  EXPECT_STREQ(kFillingWords[static_cast<std::size_t>(Filling::solid)], "solid");
  EXPECT_STREQ(kBetweenWords[static_cast<std::size_t>(Between::screw)], "screw");
  EXPECT_STREQ(kFeatureTypeWords[static_cast<std::size_t>(FeatureType::face)], "face");
  EXPECT_STREQ(kTurningWords[static_cast<std::size_t>(Turning::shortest)], "short");
  EXPECT_STREQ(kJointLimitWords[static_cast<std::size_t>(JointLimit::velocity)], "velocity");
  EXPECT_STREQ(kWhyUntestedWords[static_cast<std::size_t>(WhyUntested::both_scripted)],
               "both_scripted");
  EXPECT_STREQ(kProofVerdictWords[static_cast<std::size_t>(ProofVerdict::not_proven)],
               "not_proven");
  EXPECT_STREQ(kRobotSurfaceWords[static_cast<std::size_t>(RobotSurface::collision_or_visual)],
               "collision_or_visual");
  EXPECT_STREQ(to_string(JointType::ball), "ball");
}

}  // namespace
}  // namespace firstcontact
