#include "python/module.hpp"

#include "core/errors.hpp"
#include "core/version.hpp"
#include "protocols/registration/registration.hpp"

#include <exception>
#include <filesystem>
#include <memory>
#include <string>

#include <spdlog/details/null_mutex.h>
#include <spdlog/sinks/base_sink.h>
#include <spdlog/spdlog.h>

namespace touchtrial::python {
namespace {

namespace py = pybind11;

/// Forwards warnings to Python's logger "touchtrial".
class PythonLog final : public spdlog::sinks::base_sink<spdlog::details::null_mutex> {
  void sink_it_(const spdlog::details::log_msg& message) override {
    const std::string text = one_line(std::string(message.payload.data(), message.payload.size()));
    const py::gil_scoped_acquire gil_acquired;
    try {
      py::module_::import("logging").attr("getLogger")("touchtrial").attr("warning")("%s", text);
    } catch (py::error_already_set& error) {
      error.discard_as_unraisable("touchtrial");
    }
  }
  void flush_() override {}
};

void set_up_log() {
  auto logger = std::make_shared<spdlog::logger>("touchtrial", std::make_shared<PythonLog>());
  logger->set_level(spdlog::level::warn);
  spdlog::set_default_logger(std::move(logger));
}

void add_error(py::module_& module) {
  static py::exception<Error> error(module, "Error");
  error.attr("__module__") = "touchtrial";
  error.doc() =
      "An error that a user can cause: one line with the cause, the place and the remedy.";
  py::register_exception_translator([](std::exception_ptr failure) {
    try {
      if (failure) std::rethrow_exception(failure);
    } catch (const Error& program_error) {
      PyErr_SetString(error.ptr(), one_line(program_error.what()).c_str());
    } catch (const std::filesystem::filesystem_error& file_error) {
      PyErr_SetString(error.ptr(), one_line(file_error.what()).c_str());
    }
  });
}

}  // namespace

// NOLINTNEXTLINE: the macro's own names
PYBIND11_MODULE(_touchtrial, module) {
  module.doc() = "The native part of touchtrial; use the package.";
  module.attr("__version__") = std::string(program_version());
  set_up_log();
  registration::register_protocols();
  add_error(module);
  add_extraction(module);
  add_rendering(module);
  add_studies(module);
}

}  // namespace touchtrial::python
