/// \file Pictures that the command line names.
#pragma once

#include "engine/image_file.hpp"
#include "stimuli/import/import.hpp"

#include <filesystem>
#include <string>

#include <CLI/CLI.hpp>
#include <spdlog/spdlog.h>

namespace touchtrial::app {

/// `--bits` and `--heights`.
void add_sample_options(CLI::App& command, engine::SampleScale& scale);

/// Reads a picture, and warns of what was lost.
/// \throws FileError as engine::read_picture
[[nodiscard]] GreyImage read_given_picture(const std::filesystem::path& path,
                                           const engine::SampleScale& scale = {});

/// What `read` returns, which reads photographs. Prints all faults before it throws, unless there
/// is one, which is the error's own line.
template <typename Read>
auto naming_faults(const Read& read) {
  try {
    return read();
  } catch (const stimuli::UnusablePhotographs& error) {
    if (error.faults().size() == 1) throw;
    for (const std::string& fault : error.faults()) spdlog::error("{}", fault);
    throw;
  }
}

}  // namespace touchtrial::app
