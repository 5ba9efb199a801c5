/// \file The command-line options of the extraction methods. Private to app: it exposes the parser's
/// type.
#pragma once

#include "engine/extraction_options.hpp"

#include <array>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

namespace touchtrial::app {

/// The options as typed.
struct MethodArguments {
  std::string method = "adaptive";
  std::string norm = "additive";
  std::string gradient = "sobel";
  std::string combine = "sum";
  std::string components;  ///< "auto", "f,theta;f,theta", or empty for the default
  std::string control = "none";
  engine::ExtractionOptions values;
  const CLI::App* command = nullptr;  ///< the command that has the options
};

/// Adds --method and one option for each parameter of the methods.
/// \param arguments  must live as long as the command
void add_method_options(CLI::App& command, MethodArguments& arguments);

/// The options for the engine.
/// \throws UsageError for an option that the method lacks, or a value out of range
[[nodiscard]] engine::ExtractionOptions extraction_options(const MethodArguments& arguments);

/// The names in a table as a list for the parser.
template <typename Value, std::size_t size>
[[nodiscard]] std::vector<std::string> words_of(const std::array<Named<Value>, size>& table) {
  const auto names = names_in(table);
  return {names.begin(), names.end()};
}

}  // namespace touchtrial::app
