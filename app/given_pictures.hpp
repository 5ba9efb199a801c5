/// \file Pictures that the command line names.
#pragma once

#include "core/plane.hpp"

#include <filesystem>

#include <CLI/CLI.hpp>

namespace touchtrial::app {

/// `--bits`, which engine::read_picture takes.
/// \param bits  0 without the option
void add_bits_option(CLI::App& command, int& bits);

/// Reads a picture, and warns of what was lost.
/// \throws FileError as engine::read_picture
[[nodiscard]] GreyImage read_given_picture(const std::filesystem::path& path, int bits = 0);

}  // namespace touchtrial::app
