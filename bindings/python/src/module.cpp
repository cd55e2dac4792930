#include <firstcontact/scene/version.h>

#include "bindings.h"

namespace firstcontact::python {

PYBIND11_MODULE(_core, m) {
  m.doc() = "The library's questions, in C++. Use the package firstcontact.";
  m.attr("__version__") = version();
  bind_errors(m);
  bind_motion(m);
  bind_geometry(m);
  bind_narrowphase(m);
  bind_query(m);
  bind_scene(m);
  bind_result(m);
  bind_check_jobs(m);
  bind_robot_model(m);
  bind_trajectory(m);
  bind_robot_scene(m);
  bind_run(m);
  bind_simulator(m);
  bind_haptics(m);
  bind_verification(m);
  bind_planning(m);
  bind_retiming(m);
  refuse_unmade_objects(m);
}

}  // namespace firstcontact::python
