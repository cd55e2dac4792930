/// @file
/// A flag of objects that one thread at a time may use.

#pragma once

#include <stdexcept>
#include <string>

namespace firstcontact::python {

/// Sets a flag for its lifetime. Made and destroyed with the GIL, so that the flag needs no lock.
class Busy {
 public:
  explicit Busy(bool& flag) : flag_(flag) { flag_ = true; }
  ~Busy() { flag_ = false; }
  Busy(const Busy&) = delete;
  Busy& operator=(const Busy&) = delete;

 private:
  bool& flag_;
};

/// @param name  of the class, for the error
/// @throws std::runtime_error while another thread has the object busy
inline void require_idle(bool is_busy, const std::string& name) {
  if (is_busy) {
    throw std::runtime_error(name + ": another thread takes a step; it may be used after that");
  }
}

}  // namespace firstcontact::python
