#include "app/force_flag.hpp"

#include "core/outputs.hpp"

#include <filesystem>

#include <spdlog/spdlog.h>

namespace touchtrial::app {

CLI::Option* add_force_flag(CLI::App& command) {
  const auto notice = [](const std::filesystem::path& file, const std::filesystem::path& kept) {
    spdlog::warn("{}: is kept as {}", file.string(), kept.string());
  };
  return command.add_flag_callback(
      "--force", [=] { keep_files_in_the_way(notice); },
      "Write also where files are in the way that this program did not write, or that somebody "
      "changed since; they are kept as NAME.1, NAME.2 and so on");
}

}  // namespace touchtrial::app
