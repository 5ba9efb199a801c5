/// \file Pictures named on the command line.
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

/// Reads a picture, and warns about lost information.
/// \throws FileError as engine::read_picture
[[nodiscard]] GreyImage read_input_picture(const std::filesystem::path& path,
                                           const engine::SampleScale& scale = {});

/// Calls `read`, which reads photographs, and returns its result. If it throws, several faults are
/// printed first; a single one is only in the exception.
template <typename Read>
auto with_faults_printed(const Read& read) {
  try {
    return read();
  } catch (const stimuli::UnusablePhotographs& error) {
    if (error.faults().size() == 1) throw;
    for (const std::string& fault : error.faults()) spdlog::error("{}", fault);
    throw;
  }
}

}  // namespace touchtrial::app
