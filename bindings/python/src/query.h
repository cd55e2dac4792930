/// @file
/// The parts that the queries of Python share.

#pragma once

#include <chrono>
#include <cstddef>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <firstcontact/many_bodies/body_set.h>
#include <firstcontact/many_bodies/many_bodies.h>
#include <firstcontact/many_bodies/scene_result.h>
#include <firstcontact/query/contact.h>
#include <firstcontact/query/first_contact.h>

#include "motion.h"
#include "words.h"

namespace firstcontact::python {

/// An argument that may be None.
///
/// With a plain pointer, None would make pybind11 try every overload a second time.
template <typename T>
struct OrNone {
  T* value = nullptr;
  operator T*() const { return value; }  // NOLINT(google-explicit-constructor)
};

/// Scratch memory that a user holds.
template <typename W>
struct HeldWorkspace {
  W workspace;
  bool is_busy = false;
};

/// Scratch memory for one query: the user's, or some of an earlier query.
///
/// It is made and destroyed with the GIL, which guards all of it.
template <typename W>
class Lease {
 public:
  /// @param held  may be null
  /// @throws std::runtime_error if it serves another query
  explicit Lease(HeldWorkspace<W>* held) : held_(held) {
    if (held_ != nullptr) {
      if (held_->is_busy) {
        throw std::runtime_error("this workspace serves another query: each thread needs its own");
      }
      held_->is_busy = true;
    } else if (idle().empty()) {
      own_ = std::make_unique<W>();
    } else {
      own_ = std::move(idle().back());
      idle().pop_back();
    }
  }

  ~Lease() {
    if (held_ != nullptr) {
      held_->is_busy = false;
    } else {
      idle().push_back(std::move(own_));
    }
  }

  Lease(const Lease&) = delete;
  Lease& operator=(const Lease&) = delete;

  [[nodiscard]] W& get() { return held_ != nullptr ? held_->workspace : *own_; }

 private:
  /// Never destroyed, as there is no GIL at the end of the process.
  static std::vector<std::unique_ptr<W>>& idle() {
    static auto* const workspaces = new std::vector<std::unique_ptr<W>>;
    return *workspaces;
  }

  HeldWorkspace<W>* held_;
  std::unique_ptr<W> own_;
};

/// A set of bodies and the objects that they were made of. No query may run while it changes.
struct HeldBodySet {
  BodySet bodies;
  std::vector<pybind11::object> shapes;
  std::vector<pybind11::object> motions;
  int readers = 0;  // Queries that run; guarded by the GIL.

  /// @throws std::runtime_error if a query runs
  BodySet& changed() {
    if (readers > 0) {
      throw std::runtime_error("BodySet: a query is running; it may change after that");
    }
    return bodies;
  }
};

/// Keeps a set from changing; made and destroyed with the GIL.
class Reading {
 public:
  explicit Reading(HeldBodySet& set) : set_(set) { ++set_.readers; }
  ~Reading() { --set_.readers; }
  Reading(const Reading&) = delete;
  Reading& operator=(const Reading&) = delete;

 private:
  HeldBodySet& set_;
};

/// A pair (Shape, Motion) or (Shape, Pose) of Python, which keeps the shape and the motion.
struct GivenShape {
  const Shape* shape = nullptr;
  const Motion* motion = nullptr;
  std::shared_ptr<const Motion> rest = {};  ///< Of a pose.

  [[nodiscard]] MovingShape moving() const { return {*shape, *motion}; }
};

/// @throws pybind11::type_error
GivenShape given_shape_from(pybind11::handle value, const char* name);

/// The first shape of a question that also exists for a BodySet.
///
/// A BodySet is for the next overload; other arguments get a complaint.
struct FirstShape {
  pybind11::object value;
};

/// The time after a number of seconds; none without a number.
///
/// @throws std::invalid_argument unless > 0
std::optional<std::chrono::steady_clock::time_point> deadline_in(std::optional<double> seconds);

/// Binds contacts and the results of queries.
void bind_query_results(pybind11::module_& m);

/// States of values for pickling.
pybind11::tuple state_of(const Contact& contact);
Contact contact_from(const pybind11::tuple& state);
pybind11::tuple state_of(const PairAnswer& answer);
PairAnswer pair_answer_from(const pybind11::tuple& state);
pybind11::tuple state_of(const SceneResult& result);
SceneResult scene_result_from(const pybind11::tuple& state);

/// The contacts as a tuple of objects.
pybind11::tuple contact_tuple(const std::vector<Contact>& contacts);

/// Describes a verdict: "contact at t = 0.5".
std::string verdict_text(const Outcome& outcome);

}  // namespace firstcontact::python

namespace pybind11::detail {

template <>
class type_caster<firstcontact::python::FirstShape> {
 public:
  PYBIND11_TYPE_CASTER(firstcontact::python::FirstShape, const_name("tuple"));

  bool load(handle source, bool /*convert*/) {
    value.value = reinterpret_borrow<object>(source);
    return PyTuple_Check(source.ptr()) || !isinstance<firstcontact::python::HeldBodySet>(source);
  }
};

template <typename T>
class type_caster<firstcontact::python::OrNone<T>> {
 public:
  PYBIND11_TYPE_CASTER(firstcontact::python::OrNone<T>,
                       const_name("Optional[") + make_caster<T>::name + const_name("]"));

  bool load(handle source, bool convert) {
    if (source.is_none()) {
      return true;
    }
    make_caster<T> caster;
    if (!caster.load(source, convert)) {
      return false;
    }
    value.value = cast_op<T*>(caster);
    return true;
  }
};

}  // namespace pybind11::detail
