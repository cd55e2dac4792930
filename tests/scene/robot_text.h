/// @file
/// A small robot as files, for tests of scenes with robots.

#pragma once

#include <filesystem>
#include <fstream>
#include <string>

#include <unistd.h>

namespace firstcontact::test {

/// A folder with arm.urdf (a bar of 1 m that turns about z by `elbow`, with a fixed tip of 0.1 m),
/// arm.srdf and move.csv (elbow from 0 to 2 rad in 4 s).
class ArmFolder {
 public:
  ArmFolder()
      : path_(std::filesystem::temp_directory_path() / ("arm." + std::to_string(getpid()))) {
    std::filesystem::create_directories(path_);
    write("arm.urdf", R"(<robot name="arm">
      <link name="base"/>
      <link name="bar"><collision><origin xyz="0.5 0 0"/><geometry><box size="1 0.1 0.1"/></geometry></collision></link>
      <link name="tip"><collision><geometry><sphere radius="0.1"/></geometry></collision></link>
      <joint name="elbow" type="revolute"><parent link="base"/><child link="bar"/><axis xyz="0 0 1"/>
        <limit lower="-1" upper="1.5" velocity="1" effort="1"/></joint>
      <joint name="weld" type="fixed"><parent link="bar"/><child link="tip"/><origin xyz="1.05 0 0"/></joint>
    </robot>)");
    write("arm.srdf", R"(<robot name="arm"><group name="all"><joint name="elbow"/></group>
      <group_state name="half" group="all"><joint name="elbow" value="0.5"/></group_state></robot>)");
    write("move.csv", "time,elbow\n0,0\n4,2\n");
  }
  ~ArmFolder() { std::filesystem::remove_all(path_); }
  ArmFolder(const ArmFolder&) = delete;
  ArmFolder& operator=(const ArmFolder&) = delete;

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

  void write(const std::string& name, const std::string& text) const {
    std::ofstream(path_ / name) << text;
  }

 private:
  std::filesystem::path path_;
};

}  // namespace firstcontact::test
