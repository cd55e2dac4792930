#include <stop_token>
#include <string>
#include <utility>
#include <vector>

#include <pybind11/stl.h>

#include <firstcontact/page/write_page.h>
#include <firstcontact/scene/gap_bound.h>
#include <firstcontact/scene/gap_curve.h>
#include <firstcontact/scene/loaded_scene.h>
#include <firstcontact/scene_files/write_result.h>

#include "arrays.h"
#include "interrupts.h"
#include "query.h"
#include "scene.h"
#include "words.h"

namespace firstcontact::python {

namespace py = pybind11;

namespace {

/// Samples of the gap and its proven lower bound.
struct GapLines {
  std::vector<GapSample> samples;
  std::vector<GapPoint> lower_bound;
};

/// Samples the gap; runs without the GIL.
GapLines gap_lines(const HeldResult& result, const std::stop_token& stop) {
  const LoadedScene& loaded = result.scene->loaded();
  GapLines lines;
  lines.samples = gap_curve(loaded, time_of_interest(result.answer), stop);
  lines.lower_bound = gap_lower_bound(loaded, result.answer, lines.samples);
  return lines;
}

py::object gap_curve_of(const HeldResult& result) {
  const GapLines lines =
      run_query(nullptr, [&](const QueryStop& stop) { return gap_lines(result, stop.token()); });
  std::vector<double> t;
  std::vector<double> distance;
  std::vector<double> lower_bound;
  for (const GapSample& sample : lines.samples) {
    t.push_back(sample.t);
    distance.push_back(sample.distance);
    lower_bound.push_back(sample.lower_bound);
  }
  std::vector<double> corner_t;
  std::vector<double> corner_distance;
  for (const GapPoint& point : lines.lower_bound) {
    corner_t.push_back(point.t);
    corner_distance.push_back(point.distance);
  }
  return py::make_tuple(
      tuple_type("GapSamples")(owning(std::move(t)), owning(std::move(distance)),
                               owning(std::move(lower_bound))),
      tuple_type("GapPoints")(owning(std::move(corner_t)), owning(std::move(corner_distance))));
}

/// Makes the page as the tool's --html does.
std::string fill_page(const HeldResult& result, const std::string& page_template) {
  return run_query(nullptr, [&](const QueryStop& stop) {
    const LoadedScene& loaded = result.scene->loaded();
    const GapLines lines = gap_lines(result, stop.token());
    return write_page(
        page_template, loaded,
        write_result(loaded, result.answer, {.all_pairs = true, .sampling = result.sampling}),
        {lines.samples, lines.lower_bound});
  });
}

/// Defines a method with the body in firstcontact/_page.py.
template <typename... Arguments>
py::object page_function(const char* name, const Arguments&... arguments) {
  return py::module_::import("firstcontact._page").attr(name)(arguments...);
}

}  // namespace

void bind_result_page(ResultClass& type) {
  type.def(
          "to_html", [](const py::object& self) { return page_function("to_html", self); },
          R"(Makes the page that plays this result: one file that needs nothing else.

It is that of `firstcontact check --html`. FileNotFoundError where the package was built without
it.)")
      .def(
          "save_html",
          [](const py::object& self, const py::object& path) {
            page_function("save_html", self, path);
          },
          py::arg("path"), "Writes the page of to_html() to a file.")
      .def("_fill_page", &fill_page, py::arg("template"))
      .def("_repr_html_",
           [](const py::object& self) { return page_function("notebook_view", self); })
      .def("gap_curve", &gap_curve_of,
           R"(Samples the gap over time, for plots: (GapSamples, GapPoints).

Samples lie where the gap bends; they prove nothing between them. The points are corners of a
polyline that is a proven lower bound of the gap at all times.)");
}

}  // namespace firstcontact::python
