/// \file The contact sheet of a prepared study, for the lab book: what every code stands for, what
/// it looks like and how strong it is. It unblinds whoever reads it.
#pragma once

#include "core/plane_geometry.hpp"
#include "engine/pack/pack.hpp"
#include "engine/pictures/colour_image.hpp"
#include "engine/pictures/force_arrows.hpp"
#include "engine/rendering/field_statistics.hpp"
#include "protocols/design/study_key.hpp"

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace touchtrial::analysis {

/// More do not fit into one document that opens.
inline constexpr std::size_t kMaxSheetStimuli = 500;
/// Stimuli beside one another.
inline constexpr std::size_t kMaxSheetColumns = 5;

/// One stimulus.
struct SheetCard {
  std::string label;
  std::string exemplar;  ///< "2 of 5"; empty if the class has one image
  std::string method;    ///< in words, with the option that matters most
  std::string code;
  std::string image;            ///< name of its file
  GreyImage picture;            ///< the image, at most side_px wide and high
  engine::ColourImage texture;  ///< the same of its texture, with a frame round the patch
  engine::ColourImage arrows;   ///< the forces in the patch, square, side_px
  PlaneGeometry geometry;
  engine::ArrowPatch patch;
  double arrow_n = 0.0;  ///< force of an arrow as long as a pixel of the patch is wide
  engine::FieldStatistics statistics;
  engine::Gains gains;
  double picture_entropy = 0.0;  ///< nats
  double texture_entropy = 0.0;  ///< nats, of the texture's picture
};

struct StimulusSheet {
  std::string study;
  std::string protocol;
  std::string rendering;  ///< in words
  std::string seal;       ///< hexadecimal
  bool simulated = false;
  int side_px = 0;                            ///< of the square that every picture fits in
  std::vector<std::vector<SheetCard>> lines;  ///< of at most kMaxSheetColumns
};

/// Reads fields from the pack and pictures from the study's images. Lines are sorted by method,
/// then by class; classes of several images have lines of their own. \param side_px  of the
/// pictures, >= 1 \param progress  told after each stimulus: how many are done, of how many \throws
/// VerificationError if the pack is not the key's, or a field is damaged or not made from
///   its image: the remedy is to prepare the study again
/// \throws UsageError if there are more than kMaxSheetStimuli
/// \throws FileError if an image or a field cannot be read
[[nodiscard]] StimulusSheet make_stimulus_sheet(
    const design::StudyKey& key, const engine::Pack& pack, int side_px,
    const std::function<void(int done, int of)>& progress = {});

/// One HTML document that needs no other file and no network.
[[nodiscard]] std::string sheet_html(const StimulusSheet& sheet);

/// Draws the sheet as one tall PNG, for the owner's eyes alone.
/// \throws UsageError if it would be taller than programs open
/// \throws Error, FileError as draw_with_gnuplot
void draw_sheet_png(const StimulusSheet& sheet, const std::filesystem::path& path);

/// Draws the sheet as a PDF of A4 pages, one for each line. \throws as draw_with_gnuplot
void draw_sheet_pdf(const StimulusSheet& sheet, const std::filesystem::path& path);

}  // namespace touchtrial::analysis
