// screen: measures the physical scale of a monitor.
#include "app/commands/commands.hpp"
#include "app/terminal/console.hpp"
#include "app/windows/participant/card_screen.hpp"
#include "app/windows/participant/participant_window.hpp"
#include "core/errors.hpp"
#include "core/units.hpp"

#include <filesystem>
#include <memory>

#include <fmt/format.h>

namespace touchtrial::app {
namespace {

int calibrate_screen(const ParticipantWindowOptions& options) {
  const std::filesystem::path file = measured_screens_path();
  if (file.empty()) {
    throw UsageError(
        "screen calibrate: there is no configuration folder for the scale; set HOME or "
        "XDG_CONFIG_HOME");
  }
  ParticipantWindow window(options);
  const ScreenScale scale = window.screen();
  const auto card = std::make_shared<CardScreen>(scale.mm_per_unit);
  bool is_measured = false;
  run_beside(window, [&] {
    while (!is_measured && !window.end_reason()) is_measured = window.show_step(card).has_value();
  });
  if (!is_measured) throw UsageError("screen calibrate: cancelled; nothing was saved");
  save_measured_screen(scale.monitor, card->mm_per_unit());
  print(fmt::format("{}\n{:.5f} mm per pixel, {:.1f} pixels per inch; saved in {}\n", scale.monitor,
                    card->mm_per_unit(), kMmPerInch / card->mm_per_unit(), file.string()));
  return 0;
}

}  // namespace

void add_screen_command(CLI::App& program, Action& action) {
  CLI::App* screen = program.add_subcommand("screen", "Physical scale of a monitor");
  screen->require_subcommand(1);
  const auto [command, options] =
      add_command(*screen, action, "calibrate",
                  "Measure a monitor with a bank card, so that pictures have their true size",
                  calibrate_screen);
  add_window_options(command, options.monitor, options.size_px);
}

}  // namespace touchtrial::app
