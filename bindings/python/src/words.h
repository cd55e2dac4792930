/// @file
/// Enumerators as members of the Python enumerations in firstcontact/_words.py.
///
/// Their values are the words of scenes and results. A word may stand in place of a member.

#pragma once

#include <array>
#include <cstddef>
#include <string>

#include <pybind11/pybind11.h>

#include <firstcontact/geometry/shape.h>
#include <firstcontact/motion/motion.h>
#include <firstcontact/narrowphase/elementary_contact.h>
#include <firstcontact/narrowphase/linear_contact.h>
#include <firstcontact/query/contact.h>
#include <firstcontact/query/first_contact.h>
#include <firstcontact/query/verdict_words.h>
#include <firstcontact/robot/coordinate_path.h>
#include <firstcontact/robot/limit_report.h>
#include <firstcontact/robot/robot_description.h>
#include <firstcontact/verification/verify_run.h>

namespace firstcontact::python {

/// The Python enumeration of an enumeration, and its words in the order of the enumerators.
template <typename Enum>
struct Words;

template <>
struct Words<Verdict> {
  static constexpr const char* kName = "Verdict";
  static constexpr const auto& kWords = kVerdictWords;
};

/// The words of LinearVerdict, which has no `contact_at_start`.
template <>
struct Words<LinearVerdict> {
  static constexpr const char* kName = "Verdict";
  static constexpr std::array kWords{"free", "contact", "undecided"};
};

template <>
struct Words<UndecidedReason> {
  static constexpr const char* kName = "UndecidedReason";
  static constexpr const auto& kWords = kUndecidedReasonWords;
};

template <>
struct Words<StartContacts> {
  static constexpr const char* kName = "StartContacts";
  static constexpr const auto& kWords = kStartContactsWords;
};

/// The words of the choices that are no number.
template <>
struct Words<ContactState> {
  static constexpr const char* kName = "ContactState";
  static constexpr const auto& kWords = kContactStateWords;
  static constexpr std::array kStates{ContactState::none, ContactState::first, ContactState::all};
};

template <>
struct Words<FeatureType> {
  static constexpr const char* kName = "FeatureType";
  static constexpr const auto& kWords = kFeatureTypeWords;
};

template <>
struct Words<Between> {
  static constexpr const char* kName = "Between";
  static constexpr const auto& kWords = kBetweenWords;
};

template <>
struct Words<Filling> {
  static constexpr const char* kName = "Filling";
  static constexpr const auto& kWords = kFillingWords;
};

template <>
struct Words<ElementaryVerdict> {
  static constexpr const char* kName = "ElementaryVerdict";
  static constexpr std::array kWords{"free", "contact", "degenerate"};
};

template <>
struct Words<JointType> {
  static constexpr const char* kName = "JointType";
  static constexpr const auto& kWords = kJointTypeWords;
};

template <>
struct Words<JointLimit> {
  static constexpr const char* kName = "JointLimit";
  static constexpr const auto& kWords = kJointLimitWords;
};

template <>
struct Words<Turning> {
  static constexpr const char* kName = "Turning";
  static constexpr const auto& kWords = kTurningWords;
};

template <>
struct Words<ProofVerdict> {
  static constexpr const char* kName = "ProofVerdict";
  static constexpr const auto& kWords = kProofVerdictWords;
};

/// Refuses an answer as a condition: `if first_contact(...)` would be true for every answer.
template <class Type>
void refuse_as_condition(Type& type) {
  type.def("__bool__", [](const pybind11::object&) -> bool {
    throw pybind11::type_error(
        "an answer is neither true nor false: compare its verdict, as in verdict == \"free\"");
  });
}

/// A class of firstcontact/_tuples.py.
pybind11::object tuple_type(const char* name);

/// A member of a class of firstcontact/_words.py, kept for the lifetime of the process.
pybind11::handle member(const char* enumeration, const char* word);

/// Finds the enumerator of a word or member.
///
/// @throws pybind11::value_error that names the words
[[noreturn]] void refuse_word(const char* enumeration, const char* const* words, std::size_t count,
                              const std::string& got);

/// The caster of all these enumerations.
template <typename Enum>
class WordCaster {
  static constexpr const auto& kWords = Words<Enum>::kWords;

 public:
  PYBIND11_TYPE_CASTER(Enum, pybind11::detail::const_name("str"));

  bool load(pybind11::handle source, bool /*convert*/) {
    if (!PyUnicode_Check(source.ptr())) {
      return false;
    }
    for (std::size_t k = 0; k < kWords.size(); ++k) {
      if (PyUnicode_CompareWithASCIIString(source.ptr(), kWords[k]) == 0) {
        value = static_cast<Enum>(k);
        return true;
      }
    }
    refuse_word(Words<Enum>::kName, kWords.data(), kWords.size(), source.cast<std::string>());
  }

  static pybind11::handle cast(Enum value, pybind11::return_value_policy /*policy*/,
                               pybind11::handle /*parent*/) {
    static std::array<pybind11::handle, kWords.size()> members{};  // Filled as they are used.
    pybind11::handle& found = members[static_cast<std::size_t>(value)];
    if (!found) {
      found = member(Words<Enum>::kName, kWords[static_cast<std::size_t>(value)]);
    }
    return found.inc_ref();
  }
};

/// The choice of listed contacts: a word, or their greatest number.
class ContactStateCaster {
  using TheWords = Words<ContactState>;

 public:
  PYBIND11_TYPE_CASTER(ContactState, pybind11::detail::const_name("str | int"));

  bool load(pybind11::handle source, bool /*convert*/) {
    if (PyLong_Check(source.ptr()) && !PyBool_Check(source.ptr())) {
      const std::size_t most = PyLong_AsSize_t(source.ptr());
      if (PyErr_Occurred() != nullptr || most == 0) {
        PyErr_Clear();
        throw pybind11::value_error("contacts must be >= 1, got " +
                                    std::string(pybind11::repr(source)));
      }
      value = ContactState::nearest(most);
      return true;
    }
    if (!PyUnicode_Check(source.ptr())) {
      return false;
    }
    for (std::size_t k = 0; k < TheWords::kWords.size(); ++k) {
      if (PyUnicode_CompareWithASCIIString(source.ptr(), TheWords::kWords[k]) == 0) {
        value = TheWords::kStates[k];
        return true;
      }
    }
    refuse_word(TheWords::kName, TheWords::kWords.data(), TheWords::kWords.size(),
                source.cast<std::string>());
  }

  static pybind11::handle cast(const ContactState& state, pybind11::return_value_policy /*policy*/,
                               pybind11::handle /*parent*/) {
    if (state.kind == ContactState::Kind::nearest) {
      return pybind11::int_(state.most).release();
    }
    for (std::size_t k = 0; k < TheWords::kStates.size(); ++k) {
      if (state == TheWords::kStates[k]) {
        return member(TheWords::kName, TheWords::kWords[k]);
      }
    }
    return pybind11::none().release();
  }
};

}  // namespace firstcontact::python

namespace pybind11::detail {

template <>
class type_caster<firstcontact::Verdict>
    : public firstcontact::python::WordCaster<firstcontact::Verdict> {};
template <>
class type_caster<firstcontact::LinearVerdict>
    : public firstcontact::python::WordCaster<firstcontact::LinearVerdict> {};
template <>
class type_caster<firstcontact::UndecidedReason>
    : public firstcontact::python::WordCaster<firstcontact::UndecidedReason> {};
template <>
class type_caster<firstcontact::StartContacts>
    : public firstcontact::python::WordCaster<firstcontact::StartContacts> {};
template <>
class type_caster<firstcontact::ContactState> : public firstcontact::python::ContactStateCaster {};
template <>
class type_caster<firstcontact::FeatureType>
    : public firstcontact::python::WordCaster<firstcontact::FeatureType> {};
template <>
class type_caster<firstcontact::Between>
    : public firstcontact::python::WordCaster<firstcontact::Between> {};
template <>
class type_caster<firstcontact::Filling>
    : public firstcontact::python::WordCaster<firstcontact::Filling> {};
template <>
class type_caster<firstcontact::ElementaryVerdict>
    : public firstcontact::python::WordCaster<firstcontact::ElementaryVerdict> {};

template <>
class type_caster<firstcontact::JointType>
    : public firstcontact::python::WordCaster<firstcontact::JointType> {};
template <>
class type_caster<firstcontact::JointLimit>
    : public firstcontact::python::WordCaster<firstcontact::JointLimit> {};
template <>
class type_caster<firstcontact::Turning>
    : public firstcontact::python::WordCaster<firstcontact::Turning> {};
template <>
class type_caster<firstcontact::ProofVerdict>
    : public firstcontact::python::WordCaster<firstcontact::ProofVerdict> {};

}  // namespace pybind11::detail
