/// \file Pictures that the command line names.
#pragma once

#include "engine/image_file.hpp"

#include <filesystem>

#include <CLI/CLI.hpp>

namespace touchtrial::app {

/// `--bits` and `--heights`.
void add_sample_options(CLI::App& command, engine::SampleScale& scale);

/// Reads a picture, and warns of what was lost.
/// \throws FileError as engine::read_picture
[[nodiscard]] GreyImage read_given_picture(const std::filesystem::path& path,
                                           const engine::SampleScale& scale = {});

}  // namespace touchtrial::app
