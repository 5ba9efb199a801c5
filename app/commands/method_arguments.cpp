#include "app/commands/method_arguments.hpp"

#include "app/commands/commands.hpp"
#include "core/errors.hpp"
#include "core/text.hpp"

#include <algorithm>
#include <charconv>
#include <stdexcept>
#include <system_error>

namespace touchtrial::app {
namespace {

/// An option and the methods that use it.
struct MethodOption {
  const char* name;
  std::vector<engine::Method> methods;
};

const std::vector<MethodOption>& method_options() {
  using enum engine::Parameter;
  static const std::vector<MethodOption> options = {{"--order", methods_with(order)},
                                                    {"--radius", methods_with(radius)},
                                                    {"--norm", methods_with(norm)},
                                                    {"--gradient", methods_with(gradient)},
                                                    {"--combine", methods_with(combine)},
                                                    {"--levels", methods_with(levels)},
                                                    {"--sigma", methods_with(sigma)},
                                                    {"--threshold", methods_with(threshold)},
                                                    {"--divisor", methods_with(divisor)},
                                                    {"--lambda", methods_with(lambda)},
                                                    {"--components", methods_with(components)}};
  return options;
}

std::string methods_text(const MethodOption& option) {
  return listed(option.methods, " or ",
                [](engine::Method method) { return engine::name_of(method); });
}

void refuse_unused_seed(const CLI::App& command, engine::Control control) {
  if (control != engine::Control::none || command.count("--seed") == 0) return;
  throw UsageError("extract: --seed has no effect here; it applies to --control phase-scrambled");
}

void refuse_unused_options(const CLI::App& command, engine::Method method) {
  for (const MethodOption& option : method_options()) {
    const bool is_used =
        std::find(option.methods.begin(), option.methods.end(), method) != option.methods.end();
    if (is_used || command.count(option.name) == 0) continue;
    throw UsageError(std::string("extract: ") + option.name +
                     " has no effect here; it applies to --method " + methods_text(option));
  }
}

[[noreturn]] void refuse_components(const std::string& text) {
  throw UsageError("extract: --components: " + one_line(text) +
                   " is not auto or \"frequency,degrees;frequency,degrees\"");
}

/// Reads the number at `start`, and moves `start` past it.
double parse_number(const std::string& text, std::size_t& start) {
  double number = 0.0;
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data() + start, end, number);
  if (error != std::errc{}) refuse_components(text);
  start = static_cast<std::size_t>(stop - text.data());
  return number;
}

/// Parses "f,theta;f,theta".
std::vector<engine::GaborComponent> parse_components(const std::string& text) {
  std::vector<engine::GaborComponent> components;
  std::size_t i = 0;
  while (true) {
    engine::GaborComponent component;
    component.frequency_cycles_per_px = parse_number(text, i);
    if (i >= text.size() || text[i++] != ',') refuse_components(text);
    component.direction_deg = parse_number(text, i);
    components.push_back(component);
    if (i == text.size()) return components;
    if (text[i++] != ';') refuse_components(text);
  }
}

void read_components(const std::string& text, engine::TvGaborOptions& options) {
  options.automatic = text == "auto";
  if (!options.automatic) options.components = parse_components(text);
}

void check_ranges(const engine::ExtractionOptions& options) {
  try {
    engine::check_options(options);
  } catch (const std::invalid_argument& error) {
    const std::string message = error.what();
    const bool is_component_error =
        message.starts_with("frequency") || message.starts_with("direction");
    throw UsageError("extract: --" + (is_component_error ? "components: " + message : message));
  }
}

void add_named_options(CLI::App& command, MethodArguments& arguments) {
  command.add_option("--method", arguments.method, "Extraction method")
      ->check(CLI::IsMember(engine::method_names()))
      ->capture_default_str();
  command.add_option("--norm", arguments.norm, "Normalisation of the mask (adaptive, fixed)")
      ->check(CLI::IsMember(words_of(engine::kNormNames)))
      ->capture_default_str();
  command.add_option("--gradient", arguments.gradient, "Slope of the sub-bands (adaptive)")
      ->check(CLI::IsMember(words_of(engine::kGradientNames)))
      ->capture_default_str();
  command
      .add_option("--combine", arguments.combine,
                  "Combination of the slopes of all sub-bands (adaptive)")
      ->check(CLI::IsMember(words_of(engine::kCombineNames)))
      ->capture_default_str();
  command.add_option(
      "--components", arguments.components,
      "Oscillations that belong to the texture, \"cycles per px,degrees;..\", or auto "
      "(tv-gabor)");
  command
      .add_option("--control", arguments.control,
                  "Replace the texture with a control: the same spectrum without structure")
      ->check(CLI::IsMember(words_of(engine::kControlNames)))
      ->capture_default_str();
}

void add_number(CLI::App& command, const char* option, double& number, const char* meaning,
                double low, double high) {
  command.add_option(option, number, meaning)->check(CLI::Range(low, high))->capture_default_str();
}

void add_number_options(CLI::App& command, engine::ExtractionOptions& values) {
  using Options = engine::ExtractionOptions;
  // The parser has no half-open ranges; check_options checks this one.
  command.add_option("--order", values.order, "Fractional order, 0 <= V < 1 (fixed)");
  add_count_option(command, "--radius", values.radius,
                   "Radius K of the mask (adaptive, fixed) or of the window (median)", 1,
                   Options::kMaxRadius);
  add_count_option(command, "--levels", values.levels, "Levels of sub-bands (adaptive)", 1,
                   Options::kMaxLevels);
  command
      .add_option("--sigma", values.sigma_px,
                  "Standard deviation, pixels, 0 < S <= 1000 (gaussian)")
      ->capture_default_str();
  add_number(command, "--threshold", values.threshold_grey,
             "Smallest difference that counts as texture, grey levels (median)", 0.0, 255.0);
  add_number(command, "--divisor", values.divisor, "Divisor of the norm of the gradient (edge)",
             Options::kMinDivisor, Options::kMaxDivisor);
  add_number(command, "--lambda", values.tv_gabor.lambda, "Weight of the texture norm (tv-gabor)",
             engine::TvGaborOptions::kMinLambda, engine::TvGaborOptions::kMaxLambda);
  add_seed_option(command, values.control_seed, "Seed of the control's random phases");
}

}  // namespace

void add_method_options(CLI::App& command, MethodArguments& arguments) {
  arguments.command = &command;
  add_named_options(command, arguments);
  add_number_options(command, arguments.values);
}

engine::ExtractionOptions extraction_options(const MethodArguments& arguments) {
  const CLI::App& command = *arguments.command;
  engine::ExtractionOptions options = arguments.values;
  options.method = *engine::method_from_name(arguments.method);
  refuse_unused_options(command, options.method);
  if (options.method == engine::Method::fixed && command.count("--order") == 0) {
    throw UsageError("extract: --method fixed needs --order V, 0 <= V < 1");
  }
  options.norm = *value_in(engine::kNormNames, arguments.norm);
  options.gradient = *value_in(engine::kGradientNames, arguments.gradient);
  options.combine = *value_in(engine::kCombineNames, arguments.combine);
  options.control = *value_in(engine::kControlNames, arguments.control);
  refuse_unused_seed(command, options.control);
  if (command.count("--components") > 0) read_components(arguments.components, options.tv_gabor);
  check_ranges(options);
  return options;
}

}  // namespace touchtrial::app
