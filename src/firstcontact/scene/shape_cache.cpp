#include <firstcontact/scene/shape_cache.h>

#include <algorithm>
#include <array>
#include <bit>
#include <fstream>
#include <set>
#include <string_view>
#include <utility>
#include <variant>

#include <tbb/task_arena.h>

#include <firstcontact/geometry/hierarchy.h>
#include <firstcontact/geometry/mesh_defects.h>
#include <firstcontact/robot_files/read_urdf.h>
#include <firstcontact/scene/detail/make_shape.h>
#include <firstcontact/scene/scene_robot.h>
#include <firstcontact/text/parse_error.h>
#include <firstcontact/text/sha256.h>

namespace firstcontact {

namespace {

std::string digest_of(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  detail::Sha256 digest;
  std::array<char, 1 << 16> bytes;
  while (file.read(bytes.data(), bytes.size()) || file.gcount() > 0) {
    digest.add(std::string_view(bytes.data(), static_cast<std::size_t>(file.gcount())));
  }
  return digest.hexadecimal();
}

/// The numbers of each kind of shape, without its file; the overloads are picked by std::visit.
struct Numbers {
  using List = std::vector<double>;

  List operator()(const MeshFile& file) const { return {file.scale}; }
  List operator()(const SphereShape& sphere) const { return {sphere.radius}; }
  List operator()(const CapsuleShape& capsule) const { return {capsule.radius, capsule.length}; }
  List operator()(const BoxShape& box) const { return {box.size.x(), box.size.y(), box.size.z()}; }
  List operator()(const CylinderShape& cylinder) const { return round(cylinder); }
  List operator()(const ConeShape& cone) const { return round(cone); }
  List operator()(const EllipsoidShape& ellipsoid) const {
    List numbers(ellipsoid.radii.begin(), ellipsoid.radii.end());
    if (ellipsoid.enclosure_error) {
      numbers.push_back(*ellipsoid.enclosure_error);
    }
    return numbers;
  }
  List operator()(const PointFile& file) const { return {file.scale}; }
  List operator()(const HeightFile& file) const { return {file.cell.x(), file.cell.y()}; }
  List operator()(const ConvexHullShape& hull) const {
    const auto* file = std::get_if<MeshFile>(&hull.of);
    return {file != nullptr ? file->scale : 0.0};
  }
  template <class Inline>
  List operator()(const Inline&) const {
    return {};
  }

 private:
  template <class Round>
  static List round(const Round& shape) {
    List numbers{shape.radius, shape.length};
    if (shape.enclosure_error) {
      numbers.push_back(*shape.enclosure_error);
    }
    return numbers;
  }
};

/// Numbers as bits, so that NaN is a number like others: no shape of the cache is taken for it.
std::vector<std::uint64_t> bits_of(const std::vector<double>& numbers) {
  std::vector<std::uint64_t> bits;
  for (const double number : numbers) {
    bits.push_back(std::bit_cast<std::uint64_t>(number));
  }
  return bits;
}

/// Whether a shape is inline, so that comparing it with cached shapes gains nothing.
bool is_inline(const BodyShape& shape) {
  const auto* hull = std::get_if<ConvexHullShape>(&shape.source);
  return std::holds_alternative<Mesh>(shape.source) ||
         std::holds_alternative<PointCloud>(shape.source) ||
         std::holds_alternative<HeightMap>(shape.source) ||
         std::holds_alternative<Shape>(shape.source) ||
         (hull != nullptr && !std::holds_alternative<MeshFile>(hull->of));
}

/// The digest of a file and of the files that were read for it.
std::string digest_of(const std::filesystem::path& path, const std::vector<std::string>& also) {
  if (also.empty()) {
    return digest_of(path);
  }
  std::string digests = digest_of(path) + '\n';
  for (const std::string& file : also) {
    digests += digest_of(file) + '\n';
  }
  return detail::sha256(digests);
}

CachedShape make(const BodyShape& shape, const ReadingOptions& options) {
  const std::filesystem::path* file = detail::file_of(shape);
  ShapeReading reading = detail::make_shape(shape, options);
  CachedShape made{.shape = std::move(reading.shape), .digest = {}, .report = {}};
  if (reading.report) {
    made.report = std::make_shared<const FileReport>(std::move(*reading.report));
  }
  if (file != nullptr) {
    made.digest =
        digest_of(*file, made.report ? made.report->also_read : std::vector<std::string>());
  }
  return made;
}

/// Reads a robot with the geometry that can touch as its collision geometry.
RobotReading read_touching(const RobotFile& file, const ReadingOptions& options) {
  return read_robot(file.urdf, {.package_roots = file.package_roots,
                                .shapes = LoadShapes::collision,
                                .surface = file.surface,
                                .reading = options});
}

std::string digest_of(const RobotFile& file, const RobotReading& reading) {
  std::set<std::filesystem::path> meshes;
  for (const Link& link : reading.model.links()) {
    for (const LinkGeometry& geometry : link.collision) {
      if (const auto* mesh = std::get_if<MeshGeometry>(&geometry.source)) {
        meshes.insert(mesh->path);
      }
    }
  }
  for (const FileReport& report : reading.files) {
    meshes.insert(report.also_read.begin(), report.also_read.end());
  }
  std::string digests = digest_of(file.urdf) + '\n';
  for (const std::filesystem::path& mesh : meshes) {
    digests += digest_of(mesh) + '\n';
  }
  return detail::sha256(digests);
}

}  // namespace

CachedShape ShapeCache::load(const BodyShape& shape, const ReadingOptions& options) {
  if (is_inline(shape)) {
    return make(shape, options);
  }
  const std::filesystem::path* file = detail::file_of(shape);
  std::vector<double> numbers = std::visit(Numbers{}, shape.source);
  numbers.push_back(shape.radius);
  numbers.push_back(shape.filling == Filling::solid ? 1.0 : 0.0);
  numbers.push_back(options.lenient ? 1.0 : 0.0);
  std::unique_lock map_lock(mutex_);
  Entry& entry =
      shapes_[Key(shape.source.index(), file == nullptr ? "" : file->string(), bits_of(numbers))];
  map_lock.unlock();
  const std::scoped_lock lock(entry.making);
  if (!entry.shape) {
    // Isolated: a thread that waits for a part of a hierarchy must not take up a task that needs
    // the same shape.
    tbb::this_task_arena::isolate([&] { entry.shape = make(shape, options); });
  }
  return *entry.shape;
}

bool ShapeCache::encloses_space(const Shape& shape, const BodyShape* source) {
  const bool is_held = !shape.hierarchy().deforms() && (source == nullptr || !is_inline(*source));
  if (!is_held) {
    return why_not_solid(shape.mesh()).empty();
  }
  {
    const std::scoped_lock lock(mutex_);
    if (const auto known = encloses_space_.find(&shape.hierarchy());
        known != encloses_space_.end()) {
      return known->second;
    }
  }
  const bool encloses = why_not_solid(shape.mesh()).empty();
  const std::scoped_lock lock(mutex_);
  return encloses_space_[&shape.hierarchy()] = encloses;
}

CachedRobot ShapeCache::load(const RobotFile& file, const ReadingOptions& options) {
  std::vector<std::filesystem::path> paths = file.package_roots;
  paths.push_back(file.urdf);
  std::unique_lock map_lock(mutex_);
  RobotEntry& entry = robots_[RobotKey(file.surface, options.lenient, std::move(paths))];
  map_lock.unlock();
  const std::scoped_lock lock(entry.making);
  if (!entry.robot) {
    tbb::this_task_arena::isolate([&] {
      RobotReading reading = read_touching(file, options);
      std::string digest = digest_of(file, reading);
      entry.robot =
          CachedRobot{std::move(reading.model), std::move(digest),
                      std::make_shared<const std::vector<FileReport>>(std::move(reading.files))};
    });
  }
  return *entry.robot;
}

}  // namespace firstcontact
