#include "app/study_folder.hpp"
#include "core/version.hpp"
#include "support/catch.hpp"
#include "support/npy_array.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

using namespace touchtrial;
using namespace touchtrial::engine;

namespace {

/// A folder with a picture of noise.
struct NoiseFolder : ProgramFolder {
  NoiseFolder(int height, int width) { write_noise(height, width); }

  void write_noise(int height, int width) const {
    RandomStream random(1, "extract test");
    GreyImage image(height, width);
    for (std::uint8_t& sample : image.samples()) {
      sample = static_cast<std::uint8_t>(random.below(256));
    }
    write_png(path() / "noise.png", image);
  }
  [[nodiscard]] ProgramResult extract(const std::string& options) const {
    return type("extract @noise.png " + options);
  }
  [[nodiscard]] NpyArray dumped(const std::string& file) const {
    return read_npy(path() / (file + ".npy"));
  }
};

}  // namespace

TEST_CASE("extract writes the texture and every stage, with consistent shapes and values") {
  const NoiseFolder folder(21, 34);
  const ProgramResult result =
      succeeded(folder.extract("--dump @dump -o @out.png --precision double"));
  CHECK(line_count(result.output) == 1);
  CHECK(result.errors.empty());

  CHECK(folder.dumped("dump/image").shape == std::vector<int>{21, 34});
  CHECK(folder.dumped("dump/subband_LH").shape == std::vector<int>{11, 17});
  CHECK(folder.dumped("dump/force_tangential").shape == std::vector<int>{21, 34, 2});
  CHECK(folder.dumped("dump/order").type == "<f8");
  const auto image = folder.dumped("dump/image").samples;
  const auto texture = folder.dumped("dump/texture").samples;
  const auto enhanced = folder.dumped("dump/enhanced").samples;
  const auto rounded = folder.dumped("dump/texture_u8").samples;
  const GreyImage written = read_grey_image(folder.path() / "out.png");
  for (std::size_t i = 0; i < texture.size(); ++i) {
    CHECK(enhanced[i] == Approx(image[i] + texture[i]));
    CHECK(rounded[i] == std::min(255.0, std::max(0.0, std::floor(128 + texture[i] + 0.5))));
    CHECK(written.samples()[i] == rounded[i]);
  }
}

TEST_CASE("extract dumps single precision unless double is requested") {
  const NoiseFolder folder(5, 7);
  for (const std::string method : {"adaptive", "tv-gabor"}) {
    succeeded(folder.extract("--method " + method + " --dump @" + method));
    CHECK(folder.dumped(method + "/texture").type == "<f4");
  }
  CHECK(fs::exists(folder.in("tv-gabor/cartoon.npy")));
  CHECK_FALSE(fs::exists(folder.in("tv-gabor/order.npy")));
}

TEST_CASE("extract extracts the texture by every method and option") {
  const NoiseFolder folder(12, 17);
  for (const std::string variant :
       {"--method fixed --order 0.9 --norm sum --radius 40",
        "--norm none --mapping stretch --gradient prewitt --combine max",
        "--levels 3 --gradient central --combine l2 --mapping abs", "--method gaussian --sigma 1.5",
        "--method median --radius 1 --threshold 0", "--method edge --divisor 2",
        "--method luminance --precision double", "--method edge --control phase-scrambled --seed 7",
        "--method tv-gabor --components 0.2,0;0.3,-45.5"}) {
    INFO(variant);
    CHECK(line_count(succeeded(folder.extract(variant)).output) == 1);
  }
}

TEST_CASE("extract prints the component that auto chose, or why there is none") {
  const NoiseFolder folder(12, 17);
  const std::string automatic = "--method tv-gabor --components auto";
  CHECK_THAT(folder.extract(automatic).output, holds_text("component: 0."));
  folder.write_noise(2, 2);
  check_refused(folder.extract(automatic), 1, {"noise.png"});
}

TEST_CASE("extract applies the mapping to the picture, and never to the forces") {
  const NoiseFolder folder(12, 17);
  for (const std::string mapping : {"offset", "stretch"}) {
    succeeded(folder.extract("--mapping " + mapping + " --dump @" + mapping));
  }
  const std::vector<double> picture = folder.dumped("stretch/texture_u8").samples;
  CHECK(std::ranges::min(picture) == 0.0);
  CHECK(std::ranges::max(picture) == 255.0);
  CHECK(folder.dumped("offset/force_tangential").samples ==
        folder.dumped("stretch/force_tangential").samples);
}

TEST_CASE("extract dumps the control's texture, picture and force, and the method's orders") {
  const NoiseFolder folder(12, 17);
  succeeded(folder.extract("--dump @plain"));
  succeeded(folder.extract("--dump @control --control phase-scrambled --seed 3"));
  succeeded(folder.extract("--dump @again --control phase-scrambled --seed 3"));
  succeeded(folder.extract("--dump @wide --neighbourhood 5"));
  const auto same = [&](const std::string& name, const std::string& a, const std::string& b) {
    return read_file(folder.path() / a / name) == read_file(folder.path() / b / name);
  };
  for (const std::string name : {"texture.npy", "texture_u8.npy", "force_tangential.npy"}) {
    INFO(name);
    CHECK_FALSE(same(name, "control", "plain"));
    CHECK(same(name, "control", "again"));
  }
  CHECK(same("order.npy", "control", "plain"));
  CHECK(same("texture.npy", "wide", "plain"));
  CHECK_FALSE(same("force_tangential.npy", "wide", "plain"));
}

TEST_CASE("extract draws the force field over an enlarged patch") {
  const NoiseFolder folder(40, 50);
  CHECK(line_count(succeeded(folder.extract("--arrows @arrows.png")).output) == 2);
  CHECK(read_grey_image(folder.path() / "arrows.png").height() == 720);
}

TEST_CASE("extract refuses bad arguments with exit 2 and one line") {
  const NoiseFolder folder(5, 7);
  for (const std::string options : {"--method magic",
                                    "--method fixed",
                                    "--method fixed --order -0.1",
                                    "--method fixed --order nan",
                                    "--order 0.5",
                                    "--norm max",
                                    "--levels 9",
                                    "--sigma 2",
                                    "--components auto",
                                    "--method gaussian --sigma 0",
                                    "--method gaussian --sigma 1001",
                                    "--method gaussian --norm sum",
                                    "--method edge --divisor nan",
                                    "--method tv-gabor --mapping square",
                                    "--method tv-gabor --components 0.2",
                                    "--method tv-gabor --components 0.6,0",
                                    "--method tv-gabor --components 0.2,nan",
                                    "--method tv-gabor --components 0.2,0;",
                                    "--method tv-gabor --components ''",
                                    "--radius 0",
                                    "--radius 64",
                                    "--neighbourhood 4",
                                    "--precision half",
                                    "--control scrambled",
                                    "--control phase-scrambled --seed -1",
                                    "--seed 7",
                                    "--no-such-option"}) {
    INFO(options);
    const auto last = options.rfind("--");
    const std::string option = options.substr(last, options.find(' ', last) - last);
    check_refused(folder.extract(options), 2, {option});
  }
  check_refused(folder.extract("--method fixed --order 1"), 2, {"--order [0, 1)"});
  check_refused(folder.type("extract"), 2, {"IMAGE"});
  check_refused(folder.type("no-such-command"), 2, {"no-such-command"});
  check_refused(folder.type(""), 2, {"touchtrial --help"});
}

TEST_CASE("extract names a file that it cannot read or write, and harms none") {
  const NoiseFolder folder(5, 7);
  replace_file(folder.path() / "text.png", "this is no picture");
  check_refused(folder.type("extract @text.png"), 1, {"text.png"});
  check_refused(folder.type("extract @missing.png"), 1, {"missing.png"});
  check_refused(folder.extract("-o /no/such/folder/out.png"), 1, {"/no/such/folder/out.png"});
  const std::string before = content(folder.in("noise.png"));
  check_refused(folder.extract("-o @noise.png"), 2, {"noise.png"});
  CHECK(content(folder.in("noise.png")) == before);
  check_refused(folder.extract("-o @out.jpg"), 2, {".png"});
  CHECK_FALSE(fs::exists(folder.in("out.jpg")));
}

TEST_CASE("every command has help of 80 columns, in two ways") {
  const ProgramFolder folder;
  CHECK(
      folder.done("--version").output.starts_with("touchtrial " + std::string(program_version())));
  std::vector<std::string> commands = {""};
  std::istringstream table(folder.type("reference --table").output);
  for (std::string row; std::getline(table, row);) {
    const std::string words = row.substr(0, row.find("|-|"));
    const std::size_t bar = words.find('|');
    if (words == row || words[bar + 1] == '-') continue;
    commands.push_back(words.substr(0, bar) + (bar == 0 ? "" : " ") + words.substr(bar + 1));
  }
  CHECK(commands.size() > 40);
  for (const std::string& command : commands) {
    INFO(command);
    const ProgramResult help = folder.done(command + (command.empty() ? "" : " ") + "--help");
    CHECK_THAT(help.output, holds_text("Usage: touchtrial " + command));
    CHECK(folder.type("help " + command).output == help.output);
    std::istringstream lines(help.output);
    for (std::string line; std::getline(lines, line);) CHECK(line.size() <= 80);
  }
}

TEST_CASE("a bad argument points to the help of its own command, or to the word that was meant") {
  const ProgramFolder folder;
  check_refused(folder.type("extract"), 2, {"--help"});
  check_refused(folder.type("stimuli import --crops x"), 2, {"stimuli", "import", "--help"});
  check_refused(folder.type("--no-such-option"), 2, {"--help"});
  check_refused(folder.type("simulat"), 2, {"simulat", "simulate"});
  check_refused(folder.type("exclude a.db --participant P07 --reasn asleep"), 2,
                {"--reasn", "--reason"});
  check_refused(folder.type("stimuli sheet a.json --outptu=b.png"), 2, {"--outptu --output"});
  CHECK_THAT(folder.type("close a.db --quite-another").errors,
             !holds_text("did you mean") && holds_text("--quite-another"));
}
