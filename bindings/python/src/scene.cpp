#include "scene.h"

#include <filesystem>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <firstcontact/math/number_text.h>
#include <firstcontact/scene/loaded_scene.h>
#include <firstcontact/scene/parallel_sampling.h>
#include <firstcontact/scene/shape_cache.h>
#include <firstcontact/scene_files/read_scene.h>
#include <firstcontact/scene_files/read_simulation_scene.h>
#include <firstcontact/scene_files/write_scene.h>

#include "arrays.h"
#include "bindings.h"
#include "errors.h"
#include "interrupts.h"
#include "query.h"
#include "reports.h"

namespace firstcontact::python {

namespace py = pybind11;
using std::filesystem::path;

HeldScene::HeldScene(Scene scene, std::shared_ptr<ShapeCache> shapes)
    : scene_(std::move(scene)), shapes_(std::move(shapes)) {}

const LoadedScene& HeldScene::loaded() const {
  const std::lock_guard lock(mutex_);
  if (!loaded_) {
    loaded_ = load_scene(scene_, *shapes_);
  }
  return *loaded_;
}

std::shared_ptr<HeldScene> HeldScene::sharing(Scene scene) const {
  return std::make_shared<HeldScene>(std::move(scene), shapes_);
}

std::shared_ptr<HeldScene> HeldScene::with(const OtherOptions& options) const {
  if (options.deadline && !(*options.deadline > 0.0)) {
    throw std::invalid_argument("deadline must be > 0, got " + detail::shortest(*options.deadline));
  }
  Scene scene = scene_;
  scene.options.margin = options.margin.value_or(scene.options.margin);
  scene.options.tolerance = options.tolerance.value_or(scene.options.tolerance);
  scene.options.deadline = options.deadline ? options.deadline : scene.options.deadline;
  scene.options.contacts = options.contacts.value_or(scene.options.contacts);
  return sharing(std::move(scene));
}

const LoadedScene& loaded_without_gil(const HeldScene& scene) {
  const py::gil_scoped_release release;
  return scene.loaded();
}

namespace {

using SharedCache = std::shared_ptr<ShapeCache>;

std::shared_ptr<HeldScene> hold(Scene scene, const SharedCache& shapes) {
  auto held = std::make_shared<HeldScene>(std::move(scene),
                                          shapes ? shapes : std::make_shared<ShapeCache>());
  (void)held->loaded();
  return held;
}

std::shared_ptr<HeldScene> read(const path& file, const SharedCache& shapes, bool lenient) {
  require_file(file);
  const py::gil_scoped_release release;
  return hold(read_scene(file, {.lenient = lenient}), shapes);
}

std::shared_ptr<HeldScene> read_simulation(const path& file, const SharedCache& shapes,
                                           bool lenient) {
  require_file(file);
  const py::gil_scoped_release release;
  return hold(read_simulation_scene(file, {.lenient = lenient}), shapes);
}

std::shared_ptr<HeldScene> parse(std::string_view text, const path& source,
                                 const SharedCache& shapes, bool lenient) {
  const py::gil_scoped_release release;
  return hold(parse_scene(text, source, 1, {.lenient = lenient}), shapes);
}

/// The names of bodies, or of robots.
template <typename Named>
py::tuple all_names(const std::vector<Named>& all) {
  py::list names;
  for (const Named& one : all) {
    names.append(one.name);
  }
  return py::tuple(names);
}

/// The warnings of a scene; units that look wrong are among them.
std::string warnings_text(const HeldScene& scene) {
  const std::vector<std::string>& warnings = loaded_without_gil(scene).warnings;
  std::string text;
  for (const std::string& warning : warnings) {
    text += (text.empty() ? "; warnings: " : "; ") + printable(warning);
  }
  return text;
}

std::string describe_scene(const HeldScene& scene) {
  return "<Scene " + std::string(py::repr(py::str(scene.scene().id))) + " of " +
         std::to_string(scene.scene().bodies.size()) + " bodies, " +
         (scene.scene().robots.empty()
              ? ""
              : std::to_string(scene.scene().robots.size()) + " robots, ") +
         std::string(py::repr(py::float_(scene.scene().duration))) + " s" + warnings_text(scene) +
         ">";
}

void bind_scenes(py::module_& m) {
  py::class_<ShapeCache, SharedCache>(
      m, "ShapeCache",
      R"(Cache of shapes, kept from scene to scene; a file that changes is not read again.

Give one to load_scene for scenes that share meshes. Any number of threads may use it.)")
      .def(py::init<>());
  py::class_<HeldScene, std::shared_ptr<HeldScene>>(
      m, "Scene", R"(A scene, read and ready for questions; never changes.

load_scene and parse_scene make it. A pickled scene holds the paths of its mesh files, relative to
the working directory where they were so. It reads the files again when they are needed.)")
      .def_property_readonly("id", [](const HeldScene& s) { return s.scene().id; })
      .def_property_readonly(
          "duration", [](const HeldScene& s) { return s.scene().duration; },
          "[s] Duration of the step; t = 1 there.")
      .def_property_readonly(
          "bodies", [](const HeldScene& s) { return all_names(s.scene().bodies); },
          "Names of the bodies, in order.")
      .def_property_readonly(
          "robots", [](const HeldScene& s) { return all_names(s.scene().robots); },
          "Names of the robots, in order.")
      .def_property_readonly(
          "input_digest", [](const HeldScene& s) { return loaded_without_gil(s).input_digest; },
          "SHA-256 over all inputs.")
      .def_property_readonly(
          "files", [](const HeldScene& s) { return files_tuple(loaded_without_gil(s).files); },
          "FileReports: the reports on all files that were read.")
      .def_property_readonly(
          "warnings", [](const HeldScene& s) { return loaded_without_gil(s).warnings; },
          "Warnings of reading: unknown names, sizes that look wrong, bodies that begin inside of "
          "others.")
      .def_property_readonly(
          "pair_counts",
          [](const HeldScene& s) { return pair_counts_tuple(loaded_without_gil(s).pair_counts); },
          "PairCounts: the pairs that a check tests.")
      .def(
          "to_json", [](const HeldScene& s) { return write_scene(s.scene()); },
          "The resolved scene: poses as position and quaternion, every default written out.")
      .def(
          "to_dict",
          [](const HeldScene& s) {
            return py::module_::import("json").attr("loads")(write_scene(s.scene()));
          },
          "The resolved scene as a dict.")
      .def("__repr__", &describe_scene)
      .def(py::pickle(
          [](const HeldScene& s) {
            return py::make_tuple(write_scene(s.scene()), s.scene().text_digest, s.scene().warnings,
                                  reports_state(s.scene().file_reports), s.scene().allowed_pairs);
          },
          [](const py::tuple& state) {
            Scene scene = parse_scene(state[0].cast<std::string>(), "pickled scene");
            scene.text_digest = state[1].cast<std::string>();
            scene.warnings = state[2].cast<std::vector<std::string>>();
            scene.file_reports = reports_from(state[3]);
            scene.allowed_pairs = state[4].cast<std::vector<BodyPair>>();
            return std::make_shared<HeldScene>(std::move(scene));
          }));
  m.def("read_scene", &read, py::arg("path"), py::arg("shapes") = py::none(),
        py::arg("lenient") = false, "Reads a scene file and its meshes.");
  m.def("read_simulation_scene", &read_simulation, py::arg("path"), py::arg("shapes") = py::none(),
        py::arg("lenient") = false,
        R"(Reads a scene to simulate and its meshes: of this library, or a fixture of Rigid IPC.

shapes: a ShapeCache to share meshes with other scenes. lenient, and errors: as load_scene.)");
  m.def("parse_scene", &parse, py::arg("text"), py::arg("source") = "scene",
        py::arg("shapes") = py::none(), py::arg("lenient") = false,
        R"(Reads a scene from text, one JSON object, and its meshes.

source: the file of the text: named in errors; relative paths begin in its folder. shapes: a
ShapeCache to share meshes with other scenes. lenient, ParseError: as load_scene.)");
}

py::object sample(const HeldScene& scene, const py::object& times, OrNone<std::stop_source> stop) {
  const std::vector<double> asked = numbers_from(times, "times");
  for (const double t : asked) {
    if (!(t >= 0.0 && t <= 1.0)) {
      throw py::value_error("times must be in [0, 1], got " + std::string(py::repr(py::float_(t))));
    }
  }
  const std::vector<GapSample> samples = run_query(stop, [&](const QueryStop& query) {
    return sample_in_parallel(scene.loaded(), asked, query.token());
  });
  std::vector<double> t;
  std::vector<double> distance;
  std::vector<double> lower_bound;
  for (const GapSample& found : samples) {
    t.push_back(found.t);
    distance.push_back(found.distance);
    lower_bound.push_back(found.lower_bound);
  }
  return py::module_::import("firstcontact._tuples")
      .attr("GapSamples")(owning(std::move(t)), owning(std::move(distance)),
                          owning(std::move(lower_bound)));
}

}  // namespace

void bind_scene(py::module_& m) {
  bind_scenes(m);
  m.def("sample_gap", &sample, py::arg("scene"), py::arg("times"), py::kw_only(),
        py::arg("stop") = py::none(),
        R"(Samples the least distance of all pairs of a Scene at chosen times, sorted; on all cores.

times: [-] (n,), in [0, 1]. Proves nothing about the times between them.)");
}

}  // namespace firstcontact::python
