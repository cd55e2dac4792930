/// @file
/// Ctrl-C, and other reasons to end a query early.

#pragma once

#include <exception>
#include <functional>
#include <optional>
#include <stop_token>
#include <utility>

#include <pybind11/pybind11.h>

namespace firstcontact::python {

/// Stops the query that runs during its lifetime, on Ctrl-C in the main thread or by the user's
/// stop.
///
/// Python's own handler only notes the signal, as no Python code runs during a query. So a handler
/// before it wakes a thread that requests the stop. A stop that Python's handlers do not turn into
/// an exception is none: was_interrupted() then requests the query once more.
class QueryStop {
 public:
  /// @param user  may be null
  explicit QueryStop(const std::stop_source* user);
  ~QueryStop();
  QueryStop(const QueryStop&) = delete;
  QueryStop& operator=(const QueryStop&) = delete;

  [[nodiscard]] std::stop_token token() const { return source_.get_token(); }

  /// Prepares a query, with the GIL: earlier signals end nothing that begins now.
  ///
  /// @throws the exception of a handler
  static void handle_pending();

  /// Ends the query with an exception of a callback. May be called by any thread.
  void fail(std::exception_ptr error);

  /// Ends the watch after the query, with the GIL.
  ///
  /// @returns whether a signal stopped the query that no handler turned into an exception
  /// @throws the exception of a handler or of a callback
  [[nodiscard]] bool was_interrupted();

 private:
  std::stop_token user_;
  std::stop_source source_;
  std::optional<std::stop_callback<std::function<void()>>> forward_;
  std::exception_ptr error_;
  QueryStop* outer_ = nullptr;
  bool is_watched_ = false;
  bool interrupted_ = false;

  friend struct SignalWatch;
};

/// Runs a query without the GIL, so that other threads of Python run and Ctrl-C ends it.
///
/// @param query  called with the stop to hand on; more than once if a signal came that had no
///               effect
template <typename Query>
auto run_query(const std::stop_source* user, const Query& query) {
  while (true) {
    QueryStop stop(user);
    QueryStop::handle_pending();
    auto result = [&] {
      const pybind11::gil_scoped_release release;
      return query(stop);
    }();
    if (!stop.was_interrupted()) {
      return result;
    }
  }
}

/// A progress callback for the calling thread, which has released the GIL; its exceptions end the
/// query.
///
/// Refers to both arguments.
std::function<void(double)> progress_of(const pybind11::object& callback, QueryStop& stop);

/// Prepares signals; to be called once, at import in the main thread.
void watch_signals();

}  // namespace firstcontact::python
