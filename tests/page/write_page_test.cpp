// The page holds all that the viewer needs, word for word.

#include <firstcontact/page/write_page.h>

#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

#include <firstcontact/page/path_look.h>
#include <firstcontact/scene/gap_bound.h>
#include <firstcontact/scene/loaded_scene.h>
#include <firstcontact/scene/sample_gap.h>
#include <firstcontact/scene/shape_cache.h>
#include <firstcontact/scene_files/read_scene.h>
#include <firstcontact/text/base64.h>
#include <firstcontact/text/parse_error.h>

namespace firstcontact {
namespace {

constexpr std::string_view kTemplate = "<script>\"FIRSTCONTACT_RESULT\"</script>";

std::string base64_of(std::string_view text) {
  return detail::base64({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
}

TEST(Base64, IsAsInTheStandard) {  // RFC 4648, section 10.
  EXPECT_EQ(base64_of(""), "");
  EXPECT_EQ(base64_of("f"), "Zg==");
  EXPECT_EQ(base64_of("fo"), "Zm8=");
  EXPECT_EQ(base64_of("foo"), "Zm9v");
  EXPECT_EQ(base64_of("foobar"), "Zm9vYmFy");
  EXPECT_EQ(base64_of("\xff\xfe\xfd"), "//79");
}

LoadedScene scene_of_one_triangle() {
  ShapeCache cache;
  return load_scene(parse_scene(R"({"firstcontact": 1, "bodies": [{"name": "a", "shape":
      {"vertices": [[8, 0, 0], [10, 0, 0], [8, 4, 0]], "triangles": [[0, 1, 2]]}}]})",
                                "scene.json"),
                    cache);
}

TEST(WritePage, HoldsMeshAndGapAndResult) {
  const std::vector<GapSample> gap{{.t = 0.0, .distance = 1.0}, {.t = 0.5, .distance = 0.25}};
  const std::vector<GapPoint> bound{{.t = 0.0, .distance = 0.5}};
  const std::string page =
      write_page(kTemplate, scene_of_one_triangle(), R"({"id":"x"})", {gap, bound});
  // The middle is (9, 2, 0): the vertices are (-1, -2, 0), (1, -2, 0), (-1, 2, 0) in f32.
  EXPECT_EQ(page,
            R"(<script>{"result":{"id":"x"},"view":{"bodies":[0],"meshes":[{"origin":[9,2,0],)"
            R"("positions":"AACAvwAAAMAAAAAAAACAPwAAAMAAAAAAAACAvwAAAEAAAAAA",)"
            R"("triangles":"AAABAAIA"}],)"
            R"("gap":{"t":[0,0.5],"distance":[1,0.25]},)"
            R"("gap_bound":{"t":[0],"distance":[0.5]}}}</script>)");
}

TEST(WritePage, MarksTrianglesAroundACurvedBody) {
  const auto page_of = [](const std::string& shape) {
    ShapeCache cache;
    return write_page(
        kTemplate,
        load_scene(
            parse_scene(R"({"firstcontact": 1, "bodies": [{"name": "a", "shape": )" + shape + "}]}",
                        "scene.json"),
            cache),
        "{}", {});
  };
  for (const char* curved :
       {R"({"cylinder": {"radius": 1, "length": 2}})", R"({"cone": {"radius": 1, "length": 2}})",
        R"({"ellipsoid": {"radii": [1, 2, 3]}})"}) {
    EXPECT_NE(page_of(curved).find("\"smooth\":true"), std::string::npos) << curved;
  }
  EXPECT_EQ(page_of(R"({"box": {"size": [1, 1, 1]}})").find("smooth"), std::string::npos);
  EXPECT_NE(page_of(R"({"box": {"size": [1, 1, 1]}, "radius": 0.1})").find("\"convex\":true"),
            std::string::npos);
}

TEST(WritePage, HoldsAPathWithItsSearch) {
  PathLook path{
      .verdict = "proven",
      .edges = {{.clearance = 0.25, .from = 0.0, .to = 0.5}, {.from = 0.5, .to = 1.0}},
      .movers = {{.name = "a", .lines = {{{9, 0, 0}, {9, 1, 0}}, {{9, 1, 0}, {8, 1, 0}}}}},
      .trees = {{.kind = "start", .places = 3, .edges = 2, .movers = {{.name = "a"}}}},
      .blocked = {{{"a", "b"}, 7}}};
  path.goal.push_back({.member = 0, .X_WM = {.position = {1, 2, 3}}});
  const std::string page =
      write_page(kTemplate, scene_of_one_triangle(), "{}", {}, {.path = &path});
  // Relative to (9, 0, 0): (0, 0, 0), (0, 1, 0); (0, 1, 0), (-1, 1, 0) in f32. Until 2 and 4.
  EXPECT_NE(page.find(R"("path":{"verdict":"proven",)"
                      R"("edges":[{"clearance":0.25,"t":[0,0.5]},{"clearance":null,"t":[0.5,1]}],)"
                      R"("movers":[{"name":"a","origin":[9,0,0],"points":")"
                      R"(AAAAAAAAAAAAAAAAAAAAAAAAgD8AAAAAAAAAAAAAgD8AAAAAAACAvwAAgD8AAAAA",)"
                      R"("until":"AgAAAAQAAAA="}],)"
                      R"("trees":[{"kind":"start","places":3,"edges":2,"movers":)"
                      R"([{"name":"a","origin":[0,0,0],"points":"","until":""}]}],)"
                      R"("blocked":[{"pair":["a","b"],"count":7}],)"
                      R"("goal":[{"body":0,"position":[1,2,3],"quaternion_wxyz":[1,0,0,0]}]})"),
            std::string::npos)
      << page;
}

TEST(WritePage, HoldsTheLimitsOfRates) {
  const std::vector<RateLook> rates = {
      {.robot = "arm", .coordinate = "elbow", .velocity = 2.0, .acceleration = 3.5},
      {.robot = "arm", .coordinate = "slide", .velocity = 0.5, .acceleration = 1.0, .jerk = 20.0}};
  const std::string page =
      write_page(kTemplate, scene_of_one_triangle(), "{}", {}, {.rates = rates});
  EXPECT_NE(page.find(R"("rates":[{"robot":"arm","coordinate":"elbow","velocity":2,)"
                      R"("acceleration":3.5},{"robot":"arm","coordinate":"slide","velocity":0.5,)"
                      R"("acceleration":1,"jerk":20}])"),
            std::string::npos)
      << page;
}

TEST(ListPage, HoldsEachMeshOnceAndEachResultWordForWord) {
  ListPage list;
  list.add(R"({"id":"a","verdict":"free"})", scene_of_one_triangle());
  const std::size_t of_one = list.size();
  list.add(R"({"id":"</b>","verdict":"free"})", scene_of_one_triangle());
  EXPECT_LT(list.size() - of_one, 100U);  // Its mesh is there.
  list.add(R"({"line":3,"error":"bad <input>","scene":{}})");
  EXPECT_EQ(
      list.write(kTemplate),
      R"(<script>{"list":[{"result":{"id":"a","verdict":"free"},"view":{"bodies":[0],"meshes":[0]}},)"
      R"({"result":{"id":"\u003c/b>","verdict":"free"},"view":{"bodies":[0],"meshes":[0]}},)"
      R"({"summary":{"line":3,"error":"bad \u003cinput>"}}],)"
      R"("meshes":[{"origin":[9,2,0],"positions":"AACAvwAAAMAAAAAAAACAPwAAAMAAAAAAAACAvwAAAEAAAAAA",)"
      R"("triangles":"AAABAAIA"}]}</script>)");
  EXPECT_THROW(list.add("[]"), ParseError);
  EXPECT_THROW((void)list.write("no place"), std::invalid_argument);
}

TEST(WritePage, LetsNoNameEndTheScript) {
  const std::string page =
      write_page(kTemplate, scene_of_one_triangle(), R"({"id":"</script>"})", {});
  EXPECT_NE(page.find(R"({"id":"\u003c/script>"})"), std::string::npos) << page;
}

TEST(WritePage, RefusesAPageWithoutAPlace) {
  EXPECT_THROW((void)write_page("<html>", scene_of_one_triangle(), "{}", {}),
               std::invalid_argument);
}

}  // namespace
}  // namespace firstcontact
