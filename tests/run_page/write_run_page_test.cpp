// The page of a run holds every piece, and what rests between two of them.

#include <firstcontact/run_page/write_run_page.h>

#include <initializer_list>
#include <numbers>
#include <stdexcept>
#include <string>

#include <gtest/gtest.h>

#include <firstcontact/scene/loaded_scene.h>
#include <firstcontact/scene/shape_cache.h>

#include "record/recorded_run.h"

namespace firstcontact {
namespace {

constexpr const char* kRunTemplate = "<script>\"FIRSTCONTACT_RESULT\"</script>";

constexpr const char* kScene = R"({"firstcontact": 1, "simulation": {"duration": 4}, "bodies": [
    {"name": "</script>", "shape": {"sphere": {"radius": 0.1}}, "dynamics": {}},
    {"name": "floor", "shape": {"box": {"size": [9, 9, 0.2]}}, "pose": {"position": [0, 0, -3]}}]})";

std::string page_of(const test::RecordedRun& run) {
  RunPage page(run.header);
  for (const RunStep& step : run.steps) {
    page.add(step);
  }
  ShapeCache cache;
  return page.write(kRunTemplate, load_scene(run.header.scene, cache));
}

std::string base64(std::initializer_list<double> numbers) {
  PageNumbers row;
  for (const double number : numbers) {
    row.add(number);
  }
  return row.base64();
}

std::string base64_single(std::initializer_list<float> numbers) {
  PageNumbers row;
  for (const float number : numbers) {
    row.add(number);
  }
  return row.base64();
}

void expect_holds(const std::string& page, const std::string& part) {
  EXPECT_NE(page.find(part), std::string::npos) << part << "\n" << page;
}

TEST(RunPage, HoldsPlacesOfTheCentreOfMass) {
  test::RecordedRun run(kScene);
  run.header.centres_of_mass[0] = {0.5, 0, 0};
  const double turn = std::numbers::pi;
  run.add({{0, {{.lasts = 0.5, .velocity = {2, 0, 0}}, {.lasts = 0.5}}}});
  run.add({}).lasted = 1.0;  // Left out, it stays.
  run.steps.back().time = 2.0;
  run.add({{0, {{.lasts = 1.0, .angular_velocity = {0, 0, turn}}}}});
  const std::string page = page_of(run);
  expect_holds(page, R"("body":0,"times":")" + base64({0, 0.5, 1, 2, 3}) + '"');
  const auto angle = static_cast<float>(turn);
  expect_holds(page,
               R"("turns":")" + base64_single({0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, angle}) + '"');
  PageNumbers places;
  for (const double x : {0.5, 1.5, 1.5, 1.5}) {
    places.add(Eigen::Vector3d(x, 0, 0));
  }
  expect_holds(page, R"("places":")" + places.base64());
}

TEST(RunPage, CountsContactsStepByStep) {
  test::RecordedRun run(kScene);
  run.add({{0, {{.lasts = 1.0}}}});
  RunContact contact;
  contact.bodies = {0, 1};
  contact.point = {1, 2, 3};
  contact.distance = 0.5;
  contact.impulse = {4, 5, 6};
  run.add({{0, {{.lasts = 1.0}}}}).contacts = {contact};
  const std::string page = page_of(run);
  PageNumbers until;
  until.add(0, 4);
  until.add(1, 4);
  PageNumbers bodies;
  bodies.add(0, 4);
  bodies.add(1, 4);
  expect_holds(page, R"("contacts":{"until":")" + until.base64() + R"(","bodies":")" +
                         bodies.base64() + R"(","points":")" + base64({1, 2, 3}) +
                         R"(","impulses":")" + base64_single({4, 5, 6}) + R"(","distances":")" +
                         base64_single({0.5F}) + "\"}");
}

TEST(RunPage, HoldsDevicesFromTheirFirstStepOn) {
  test::RecordedRun run(kScene);
  run.add({{0, {{.lasts = 1.0}}}});
  EXPECT_EQ(page_of(run).find("\"devices\""), std::string::npos);
  RunDevice device;
  device.X_WB = {{1, 2, 3}, Eigen::Quaterniond(0, 1, 0, 0)};
  device.force = {4, 5, 6};
  device.torque = {7, 8, 9};
  run.add({{0, {{.lasts = 1.0}}}}).devices = {device};
  const std::string page = page_of(run);
  PageNumbers steps;
  steps.add(1, 4);
  expect_holds(page, R"("devices":[{"body":0,"steps":")" + steps.base64() + R"(","positions":")" +
                         base64({1, 2, 3}) + R"(","rotations":")" + base64_single({0, 1, 0, 0}) +
                         R"(","forces":")" + base64_single({4, 5, 6}) + R"(","torques":")" +
                         base64_single({7, 8, 9}) + "\"}]");
}

TEST(RunPage, HoldsLinksWhereDevicesLeadThem) {
  test::RecordedRun run(kScene);
  RunDevice device;
  device.links = {{.body = 1, .X_WB = {{1, 2, 3}, Eigen::Quaterniond(0, 1, 0, 0)}}};
  run.add({{0, {{.lasts = 1.0}}}}).devices = {device};
  expect_holds(page_of(run), R"(,"links":[{"body":1,"positions":")" + base64({1, 2, 3}) +
                                 R"(","rotations":")" + base64_single({0, 1, 0, 0}) + "\"}]}]");
}

TEST(RunPage, SaysWhereLinksBegin) {
  test::RecordedRun run(kScene);
  run.add({{0, {{.lasts = 1.0}}}});
  expect_holds(page_of(run), R"("links_from":2,)");
}

TEST(RunPage, HoldsTheHeaderWithoutAnEndOfItsScript) {
  test::RecordedRun run(kScene);
  run.add({{0, {{.lasts = 1.0}}}});
  const std::string page = page_of(run);
  expect_holds(page, R"(<script>{"run":{"header":{"firstcontact_run":1,)");
  expect_holds(page, R"(\u003c/script>)");
  EXPECT_EQ(page.find("</script>"), page.rfind("</script>"));
}

TEST(RunPage, RefusesARunOfNoTime) {
  EXPECT_THROW((void)page_of(test::RecordedRun(kScene)), std::invalid_argument);
}

}  // namespace
}  // namespace firstcontact
