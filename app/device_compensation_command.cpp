// device compensation: what shaping forces for a device's model would deliver, and what it costs.
#include "analysis/text_table.hpp"
#include "app/commands.hpp"
#include "app/console.hpp"
#include "device/compensation/compensation_figures.hpp"
#include "device/compensation/force_shaper.hpp"
#include "device/registry.hpp"

#include <memory>
#include <string>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace touchtrial::app {
namespace {

struct CompensationArguments {
  std::string model;
  std::string hand{device::name_of(device::HandKind::stylus_grip)};
  double most_gain_db = 12.0;
  bool json = false;
};

device::HandOptions hand_of(const CompensationArguments& arguments) {
  device::HandOptions hand;
  hand.model = arguments.hand == device::name_of(device::HandKind::point_mass)
                   ? device::HandKind::point_mass
                   : device::HandKind::stylus_grip;
  return hand;
}

std::string millinewtons(double n) {
  return fmt::format("{:.2f}", 1000.0 * n);
}

std::string compensation_text(const CompensationArguments& arguments,
                              const device::CompensationFigures& figures) {
  analysis::TextTable response({"Hz", "ideal", "without", "with", "gain dB"}, {});
  for (const device::TipResponse& at : figures.responses) {
    response.add({fmt::format("{:g}", at.frequency_hz), fmt::format("{:.2f}", at.ideal_m_s2_per_n),
                  fmt::format("{:.2f}", at.without_m_s2_per_n),
                  fmt::format("{:.2f}", at.with_m_s2_per_n), fmt::format("{:.1f}", at.gain_db)});
  }
  analysis::TextTable cost({"cost", "without", "with"});
  const device::WallFigures& without = figures.without;
  const device::WallFigures& with = figures.with;
  cost.add({"noise, motors, mN rms", millinewtons(without.noise_motors_n),
            millinewtons(with.noise_motors_n)});
  cost.add(
      {"noise, tip, mN rms", millinewtons(without.noise_tip_n), millinewtons(with.noise_tip_n)});
  cost.add({"stiffest wall, N/mm", fmt::format("{:.2f}", without.stiffest_n_per_mm),
            fmt::format("{:.2f}", with.stiffest_n_per_mm)});
  return fmt::format("{} in a hand of the kind {}, shaped by at most {:g} dB: SIMULATED\n\n",
                     arguments.model, arguments.hand, arguments.most_gain_db) +
         "Acceleration of the tip along a stroke, m/s^2 per newton\n" + response.text() + "\n" +
         cost.text() + "\n" +
         analysis::wrapped("", fmt::format("Noise is that of encoder steps on a wall of {:g} N/mm. "
                                           "A wall is called stable up to the first of growing "
                                           "stiffness, to {:g} N/mm, that keeps swinging. No "
                                           "number was measured on a device, and no session with "
                                           "people shapes forces.",
                                           device::kNoiseWallNPerMm, device::kStiffestWallNPerMm));
}

nlohmann::ordered_json wall_json(const device::WallFigures& wall) {
  return {{"noise_motors_n", wall.noise_motors_n},
          {"noise_tip_n", wall.noise_tip_n},
          {"stiffest_n_per_mm", wall.stiffest_n_per_mm}};
}

std::string compensation_json(const CompensationArguments& arguments,
                              const device::CompensationFigures& figures) {
  using nlohmann::ordered_json;
  ordered_json responses = ordered_json::array();
  for (const device::TipResponse& at : figures.responses) {
    responses.push_back({{"frequency_hz", at.frequency_hz},
                         {"ideal_m_s2_per_n", at.ideal_m_s2_per_n},
                         {"without_m_s2_per_n", at.without_m_s2_per_n},
                         {"with_m_s2_per_n", at.with_m_s2_per_n},
                         {"gain_db", at.gain_db}});
  }
  return json_text(ordered_json{{"model", arguments.model},
                                {"hand", arguments.hand},
                                {"most_gain_db", arguments.most_gain_db},
                                {"simulated", true},
                                {"responses", responses},
                                {"wall_n_per_mm", device::kNoiseWallNPerMm},
                                {"without", wall_json(figures.without)},
                                {"with", wall_json(figures.with)}});
}

int compensate(const CompensationArguments& arguments) {
  const device::CompensationFigures figures = device::measure_compensation(
      device::model_of_device(arguments.model), hand_of(arguments), arguments.most_gain_db);
  print(arguments.json ? compensation_json(arguments, figures)
                       : compensation_text(arguments, figures));
  return 0;
}

}  // namespace

void add_device_compensation_command(CLI::App& device, Action& action) {
  auto arguments = std::make_shared<CompensationArguments>();
  CLI::App* command = device.add_subcommand(
      "compensation",
      "Simulate what shaping forces for a device's mass and structure would deliver and cost");
  command
      ->add_option("MODEL", arguments->model,
                   "Device model, as touchtrial device models names it, or a file")
      ->required();
  command
      ->add_option("--hand", arguments->hand, "The hand that holds it: stylus_grip or point_mass")
      ->check(CLI::IsMember({device::name_of(device::HandKind::stylus_grip),
                             device::name_of(device::HandKind::point_mass)}))
      ->capture_default_str();
  command
      ->add_option("--most-gain-db", arguments->most_gain_db,
                   "Bound of the gain at any frequency, dB")
      ->check(finite_range(0.0, device::kMostGainDb))
      ->capture_default_str();
  add_json_flag(*command, arguments->json);
  command->callback([=, &action] { action = [=] { return compensate(*arguments); }; });
}

}  // namespace touchtrial::app
