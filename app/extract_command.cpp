#include "app/commands.hpp"
#include "app/console.hpp"
#include "core/errors.hpp"
#include "core/npy.hpp"
#include "engine/entropy.hpp"
#include "engine/extraction.hpp"
#include "engine/force_field.hpp"
#include "engine/image_file.hpp"

#include <algorithm>
#include <filesystem>
#include <memory>
#include <stdexcept>
#include <string>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

namespace touchtrial {
namespace {

namespace fs = std::filesystem;

struct ExtractArguments {
  fs::path image;
  std::string method = "adaptive";
  double order = 0.0;
  int radius = 2;
  double lambda = TvGaborOptions{}.lambda;
  int neighbourhood = 3;
  std::string precision = "float";
  fs::path output;
  fs::path dump;
};

/// One option and the methods that it means something to.
void refuse_unused(const CLI::App& command, const std::string& option, bool used,
                   const std::string& remedy) {
  if (!used && command.count(option) > 0) {
    throw UsageError("extract: " + option + " means nothing here; " + remedy);
  }
}

ExtractionOptions options_from(const CLI::App& command, const ExtractArguments& arguments) {
  ExtractionOptions options;
  options.method = *method_from_name(arguments.method);
  options.radius = arguments.radius;
  options.tv_gabor.lambda = arguments.lambda;
  const bool fixed = options.method == Method::fixed;
  const bool tv_gabor = options.method == Method::tv_gabor;
  refuse_unused(command, "--order", fixed, "it goes with --method fixed");
  refuse_unused(command, "--radius", !tv_gabor, "it goes with --method adaptive or fixed");
  refuse_unused(command, "--lambda", tv_gabor, "it goes with --method tv-gabor");
  if (fixed && command.count("--order") == 0) {
    throw UsageError("extract: --method fixed needs --order V, 0 <= V < 1");
  }
  if (fixed) options.order = arguments.order;
  try {
    check_options(options);
  } catch (const std::invalid_argument& error) {
    throw UsageError(std::string("extract: --") + error.what());
  }
  return options;
}

template <typename Real>
void dump_if_made(const fs::path& folder, const std::string& name, const Plane<Real>& plane) {
  if (!plane.empty()) write_npy(folder / (name + ".npy"), plane);
}

/// (H, W, 2): the force's x, then y, at each pixel.
template <typename Real>
void dump_force(const fs::path& folder, const ForceField<Real>& force) {
  std::vector<Real> interleaved;
  interleaved.reserve(2 * force.x.size());
  for (std::size_t i = 0; i < force.x.size(); ++i) {
    interleaved.push_back(force.x.samples()[i]);
    interleaved.push_back(force.y.samples()[i]);
  }
  write_npy<Real>(folder / "force_tangential.npy", interleaved,
                  {force.x.height(), force.x.width(), 2});
}

template <typename Real>
void dump_all(const fs::path& folder, const GreyImage& image, const Extraction<Real>& extraction,
              int neighbourhood) {
  fs::create_directories(folder);
  dump_if_made(folder, "image", image);
  dump_if_made(folder, "subband_LL", extraction.sub_band_ll);
  dump_if_made(folder, "subband_LH", extraction.sub_band_lh);
  dump_if_made(folder, "subband_HL", extraction.sub_band_hl);
  dump_if_made(folder, "subband_HH", extraction.sub_band_hh);
  dump_if_made(folder, "csgv", extraction.csgv);
  dump_if_made(folder, "order", extraction.order);
  dump_if_made(folder, "texture", extraction.texture);
  dump_if_made(folder, "enhanced", extraction.enhanced);
  dump_if_made(folder, "cartoon", extraction.cartoon);
  dump_if_made(folder, "texture_u8", texture_picture(extraction.texture));
  dump_force(folder, tangential_force(texture_surface(extraction.texture), neighbourhood));
}

template <typename Real>
std::string summary(const ExtractArguments& arguments, const Extraction<Real>& extraction,
                    const GreyImage& picture) {
  const auto samples = extraction.texture.samples();
  const auto [low, high] = std::minmax_element(samples.begin(), samples.end());
  return fmt::format(
      "{}: {} x {} px, {}, texture {:.3f} to {:.3f} grey levels, entropy {:.4f} nats\n",
      arguments.image.string(), picture.width(), picture.height(), arguments.method,
      static_cast<double>(*low), static_cast<double>(*high), entropy(picture));
}

template <typename Real>
int extract_with(const ExtractArguments& arguments, const ExtractionOptions& options) {
  const GreyImage image = read_grey_image(arguments.image);
  const bool dumping = !arguments.dump.empty();
  const Extraction<Real> extraction =
      extract_texture<Real>(image, options, dumping ? WantedPlanes::all() : WantedPlanes{});
  if (!extraction.converged) {
    spdlog::warn("{}: tv-gabor stopped after {} steps with a relative gap of {:.2g}",
                 arguments.image.string(), extraction.steps, extraction.gap);
  }
  const GreyImage picture = texture_picture(extraction.texture);
  if (!arguments.output.empty()) write_png(arguments.output, picture);
  if (dumping) dump_all(arguments.dump, image, extraction, arguments.neighbourhood);
  print(summary(arguments, extraction, picture));
  return 0;
}

int extract(const CLI::App& command, const ExtractArguments& arguments) {
  const ExtractionOptions options = options_from(command, arguments);
  if (arguments.neighbourhood % 2 == 0) {
    throw UsageError("extract: --neighbourhood is a side length and must be odd, 3 or more");
  }
  return arguments.precision == "double" ? extract_with<double>(arguments, options)
                                         : extract_with<float>(arguments, options);
}

}  // namespace

void add_extract_command(CLI::App& program, Action& action) {
  auto arguments = std::make_shared<ExtractArguments>();
  CLI::App* command = program.add_subcommand("extract", "Take the texture from one image");
  command->add_option("IMAGE", arguments->image, "PNG, JPEG, TIFF, BMP or PGM")->required();
  command->add_option("--method", arguments->method, "How the texture is taken")
      ->check(CLI::IsMember(method_names()))
      ->capture_default_str();
  command->add_option("--order", arguments->order, "Fractional order, 0 <= V < 1 (fixed)")
      ->check(CLI::Range(0.0, std::nextafter(1.0, 0.0)));
  command->add_option("--radius", arguments->radius, "Radius K of the mask (adaptive, fixed)")
      ->check(CLI::Range(1, ExtractionOptions::kMaxRadius))
      ->capture_default_str();
  command->add_option("--lambda", arguments->lambda, "Weight of the texture norm (tv-gabor)")
      ->check(CLI::Range(TvGaborOptions::kMinLambda, TvGaborOptions::kMaxLambda))
      ->capture_default_str();
  command
      ->add_option("--neighbourhood", arguments->neighbourhood,
                   "Side n of the force's neighbourhood, odd")
      ->check(CLI::Range(3, 1001))
      ->capture_default_str();
  command->add_option("-o,--output", arguments->output, "Write the texture as an 8-bit PNG");
  command->add_option("--dump", arguments->dump,
                      "Write every stage as .npy files into this folder");
  command->add_option("--precision", arguments->precision, "Arithmetic of the extraction")
      ->check(CLI::IsMember({"float", "double"}))
      ->capture_default_str();
  command->callback([=, &action] { action = [=] { return extract(*command, *arguments); }; });
}

}  // namespace touchtrial
