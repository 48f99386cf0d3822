// Every entry of the shim runs inside guard(): OCCT's exceptions are no std::exception, and cxx knows only those.
#pragma once
#include <Standard_Failure.hxx>
#include <stdexcept>
#include <string>

namespace occt {

template <class F> auto guard(const char* where, F&& body) -> decltype(body()) {
  try {
    return body();
  } catch (const Standard_Failure& failure) {
    const char* text = failure.GetMessageString();
    throw std::runtime_error(std::string(where) + ": " + failure.DynamicType()->Name() + (text && *text ? std::string(": ") + text : ""));
  } catch (const std::exception& error) {
    throw std::runtime_error(std::string(where) + ": " + error.what());
  } catch (...) {
    throw std::runtime_error(std::string(where) + ": unknown exception");
  }
}

} // namespace occt
