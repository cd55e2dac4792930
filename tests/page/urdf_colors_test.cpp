// Links have the colours of their file; any error in the file costs at most a colour.

#include <firstcontact/page/detail/urdf_colors.h>

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

namespace firstcontact::detail {
namespace {

using Colors = std::vector<std::optional<Eigen::Vector3d>>;

Colors colors_of_hand(std::string_view visuals, std::string_view before = "") {
  const std::string urdf = "<robot name='r'>" + std::string(before) + "<link name='hand'>" +
                           std::string(visuals) + "</link></robot>";
  const UrdfColors colors = parse_urdf_colors(urdf);
  return colors.contains("hand") ? colors.at("hand") : Colors{};
}

TEST(UrdfColors, AreTakenByNameOrFromTheVisualItself) {
  constexpr std::string_view kRed = "<material name='red'><color rgba='1 0 0.25 0.5'/></material>";
  const Colors colors = colors_of_hand(
      "<visual><material name='red'/></visual>"
      "<visual/>"
      "<visual><material name='own'><color rgba='0 1 0 1'/></material></visual>"
      "<visual><material name='own'/></visual>",
      kRed);
  const Eigen::Vector3d red(1.0, 0.0, 0.25);
  const Eigen::Vector3d green(0.0, 1.0, 0.0);
  EXPECT_EQ(colors, (Colors{red, std::nullopt, green, green}));
}

TEST(UrdfColors, AreLeftOutWhereTheyAreNone) {
  EXPECT_EQ(colors_of_hand("<visual><material name='unknown'/></visual>"
                           "<visual><material><color rgba='a b c d'/></material></visual>"
                           "<visual><material><color rgba='1 1'/></material></visual>"
                           "<visual><material><color/></material></visual>"),
            Colors(4));
  EXPECT_TRUE(parse_urdf_colors("").empty());
  EXPECT_TRUE(parse_urdf_colors("<robot><link>").empty());
  EXPECT_TRUE(parse_urdf_colors("<sdf/>").empty());
  EXPECT_TRUE(read_urdf_colors("no such file").empty());
}

TEST(UrdfColors, StayBetweenZeroAndOne) {
  const Colors colors =
      colors_of_hand("<visual><material><color rgba='-1 255 0.5 1'/></material></visual>");
  ASSERT_EQ(colors.size(), 1U);
  EXPECT_EQ(colors[0], Eigen::Vector3d(0.0, 1.0, 0.5));
}

}  // namespace
}  // namespace firstcontact::detail
