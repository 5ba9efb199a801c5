#include "app/method_arguments.hpp"

#include "app/commands.hpp"
#include "core/errors.hpp"

#include <algorithm>
#include <charconv>
#include <stdexcept>
#include <system_error>

namespace touchtrial::app {
namespace {

/// An option and the methods that it means something to.
struct MethodOption {
  const char* name;
  std::vector<engine::Method> methods;
};

const std::vector<MethodOption>& method_options() {
  using enum engine::Method;
  static const std::vector<MethodOption> options = {
      {"--order", {fixed}},          {"--radius", {adaptive, fixed, median}},
      {"--norm", {adaptive, fixed}}, {"--gradient", {adaptive}},
      {"--combine", {adaptive}},     {"--levels", {adaptive}},
      {"--sigma", {gaussian}},       {"--threshold", {median}},
      {"--divisor", {edge}},         {"--lambda", {tv_gabor}},
      {"--components", {tv_gabor}}};
  return options;
}

std::string owners_of(const MethodOption& option) {
  std::string owners;
  for (std::size_t i = 0; i < option.methods.size(); ++i) {
    if (i > 0) owners += i + 1 == option.methods.size() ? " or " : ", ";
    owners += engine::name_of(option.methods[i]);
  }
  return owners;
}

void refuse_unused_seed(const CLI::App& command, engine::Control control) {
  if (control != engine::Control::none || command.count("--seed") == 0) return;
  throw UsageError("extract: --seed means nothing here; it goes with --control phase-scrambled");
}

void refuse_unused(const CLI::App& command, engine::Method method) {
  for (const MethodOption& option : method_options()) {
    const bool used =
        std::find(option.methods.begin(), option.methods.end(), method) != option.methods.end();
    if (used || command.count(option.name) == 0) continue;
    throw UsageError(std::string("extract: ") + option.name +
                     " means nothing here; it goes with --method " + owners_of(option));
  }
}

[[noreturn]] void refuse_components(const std::string& text) {
  throw UsageError("extract: --components: " + one_line(text) +
                   " is not auto or \"frequency,degrees;frequency,degrees\"");
}

/// The number that begins at `from`, which moves behind it.
double take_number(const std::string& text, std::size_t& from) {
  double number = 0.0;
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data() + from, end, number);
  if (error != std::errc{}) refuse_components(text);
  from = static_cast<std::size_t>(stop - text.data());
  return number;
}

/// "f,theta;f,theta"
std::vector<engine::GaborComponent> components_from(const std::string& text) {
  std::vector<engine::GaborComponent> components;
  std::size_t i = 0;
  while (true) {
    engine::GaborComponent component;
    component.frequency_cycles_per_px = take_number(text, i);
    if (i >= text.size() || text[i++] != ',') refuse_components(text);
    component.direction_deg = take_number(text, i);
    components.push_back(component);
    if (i == text.size()) return components;
    if (text[i++] != ';') refuse_components(text);
  }
}

void read_components(const std::string& text, engine::TvGaborOptions& options) {
  options.automatic = text == "auto";
  if (!options.automatic) options.components = components_from(text);
}

void check(const engine::ExtractionOptions& options) {
  try {
    engine::check_options(options);
  } catch (const std::invalid_argument& error) {
    const std::string what = error.what();
    const bool of_component = what.starts_with("frequency") || what.starts_with("direction");
    throw UsageError("extract: --" + (of_component ? "components: " + what : what));
  }
}

void add_words(CLI::App& command, MethodArguments& arguments) {
  command.add_option("--method", arguments.method, "How the texture is taken")
      ->check(CLI::IsMember(engine::method_names()))
      ->capture_default_str();
  command.add_option("--norm", arguments.norm, "Normalisation of the mask (adaptive, fixed)")
      ->check(CLI::IsMember(words_of(engine::kNormNames)))
      ->capture_default_str();
  command.add_option("--gradient", arguments.gradient, "Slope of the sub-bands (adaptive)")
      ->check(CLI::IsMember(words_of(engine::kGradientNames)))
      ->capture_default_str();
  command
      .add_option("--combine", arguments.combine, "One number of all sub-bands' slopes (adaptive)")
      ->check(CLI::IsMember(words_of(engine::kCombineNames)))
      ->capture_default_str();
  command.add_option("--components", arguments.components,
                     "Oscillations that are texture, \"cycles per px,degrees;..\", or auto "
                     "(tv-gabor)");
  command
      .add_option("--control", arguments.control,
                  "Make of the texture its own control: the same spectrum without structure")
      ->check(CLI::IsMember(words_of(engine::kControlNames)))
      ->capture_default_str();
}

void add_number(CLI::App& command, const char* option, double& number, const char* meaning,
                double low, double high) {
  command.add_option(option, number, meaning)->check(CLI::Range(low, high))->capture_default_str();
}

void add_numbers(CLI::App& command, engine::ExtractionOptions& numbers) {
  using Options = engine::ExtractionOptions;
  // Of a half-open range the parser would say that its end is not in it; check_options says why.
  command.add_option("--order", numbers.order, "Fractional order, 0 <= V < 1 (fixed)");
  command
      .add_option("--radius", numbers.radius,
                  "Radius K of the mask (adaptive, fixed) or of the window (median)")
      ->check(CLI::Range(1, Options::kMaxRadius))
      ->capture_default_str();
  command.add_option("--levels", numbers.levels, "Levels of sub-bands (adaptive)")
      ->check(CLI::Range(1, Options::kMaxLevels))
      ->capture_default_str();
  command
      .add_option("--sigma", numbers.sigma_px,
                  "Standard deviation, pixels, 0 < S <= 1000 (gaussian)")
      ->capture_default_str();
  add_number(command, "--threshold", numbers.threshold_grey,
             "Difference that is no texture yet, grey levels (median)", 0.0, 255.0);
  add_number(command, "--divisor", numbers.divisor, "Of the norm of the gradient (edge)",
             Options::kMinDivisor, Options::kMaxDivisor);
  add_number(command, "--lambda", numbers.tv_gabor.lambda, "Weight of the texture norm (tv-gabor)",
             engine::TvGaborOptions::kMinLambda, engine::TvGaborOptions::kMaxLambda);
  command.add_option("--seed", numbers.control_seed, "Of the control's random phases")
      ->check(seed_validator())
      ->capture_default_str();
}

}  // namespace

void add_method_options(CLI::App& command, MethodArguments& arguments) {
  add_words(command, arguments);
  add_numbers(command, arguments.numbers);
}

engine::ExtractionOptions extraction_options(const CLI::App& command,
                                             const MethodArguments& arguments) {
  engine::ExtractionOptions options = arguments.numbers;
  options.method = *engine::method_from_name(arguments.method);
  refuse_unused(command, options.method);
  if (options.method == engine::Method::fixed && command.count("--order") == 0) {
    throw UsageError("extract: --method fixed needs --order V, 0 <= V < 1");
  }
  options.norm = *engine::choice_named<engine::Norm>(engine::kNormNames, arguments.norm);
  options.gradient =
      *engine::choice_named<engine::Gradient>(engine::kGradientNames, arguments.gradient);
  options.combine =
      *engine::choice_named<engine::Combine>(engine::kCombineNames, arguments.combine);
  options.control =
      *engine::choice_named<engine::Control>(engine::kControlNames, arguments.control);
  refuse_unused_seed(command, options.control);
  if (command.count("--components") > 0) read_components(arguments.components, options.tv_gabor);
  check(options);
  return options;
}

}  // namespace touchtrial::app
