/// \file The source paper's published numbers: Table 1, the accuracies of Fig. 6 and the stated
/// improvement. Source: Haptic Texture Rendering of 2D Image Based on Adaptive Fractional
/// Differential Method.
#pragma once

#include <array>
#include <cstddef>

namespace touchtrial::analysis {

/// One picture in Table 1: a statistic in the directions 0, 45, 90 and 135 degrees.
using PublishedCells = std::array<double, 4>;

/// One statistic of one picture before and after extraction.
struct PublishedRow {
  PublishedCells original;
  PublishedCells texture;
};

/// Table 1 by picture. `entropy` is the column with that name in the paper.
struct PublishedPicture {
  PublishedRow asm_;
  PublishedRow entropy;
  PublishedRow contrast;
  PublishedRow correlation;
};

/// Half a unit of the last digit printed for the angular second moment and "Entropy".
inline constexpr double kPublishedAsmRounding = 0.5e-5;
inline constexpr double kPublishedEntropyRounding = 0.5e-4;

inline constexpr std::array<PublishedPicture, 5> kPublishedTable = {{
    {{{0.00015, 0.00013, 0.00013, 0.00011}, {0.00038, 0.00031, 0.00034, 0.00030}},
     {{0.0120, 0.0112, 0.0115, 0.0105}, {0.0195, 0.0175, 0.0183, 0.0174}},
     {{457.73, 657.91, 531.97, 1177.25}, {238.31, 479.46, 341.27, 547.85}},
     {{0.843, 0.774, 0.817, 0.596}, {0.608, 0.213, 0.439, 0.101}}},
    {{{0.00040, 0.00028, 0.00037, 0.00029}, {0.00075, 0.00060, 0.00077, 0.00061}},
     {{0.0201, 0.0167, 0.0192, 0.0169}, {0.0274, 0.0246, 0.0277, 0.0246}},
     {{202.81, 782.97, 616.01, 780.25}, {122.90, 238.49, 134.69, 243.24}},
     {{0.897, 0.602, 0.687, 0.604}, {0.647, 0.316, 0.614, 0.303}}},
    {{{0.00011, 0.00009, 0.00011, 0.00010}, {0.00011, 0.00009, 0.00010, 0.00009}},
     {{0.0105, 0.0094, 0.0103, 0.0099}, {0.0104, 0.0096, 0.0102, 0.0100}},
     {{555.80, 1184.74, 621.75, 940.61}, {1117.87, 2451.20, 1251.64, 1540.86}},
     {{0.888, 0.760, 0.875, 0.811}, {0.627, 0.183, 0.582, 0.487}}},
    {{{0.00027, 0.00023, 0.00036, 0.00023}, {0.00052, 0.00048, 0.00061, 0.00047}},
     {{0.0162, 0.0153, 0.0189, 0.0151}, {0.0228, 0.0219, 0.0247, 0.0217}},
     {{738.38, 970.86, 544.27, 1283.43}, {221.82, 293.59, 165.43, 323.46}},
     {{0.790, 0.723, 0.846, 0.635}, {0.465, 0.294, 0.603, 0.222}}},
    {{{0.00066, 0.00041, 0.00061, 0.00040}, {0.00273, 0.00187, 0.00245, 0.00188}},
     {{0.0258, 0.0202, 0.0247, 0.0200}, {0.0522, 0.0433, 0.0495, 0.0433}},
     {{383.83, 601.95, 247.00, 644.16}, {89.14, 135.43, 54.82, 136.63}},
     {{0.879, 0.812, 0.923, 0.799}, {0.610, 0.407, 0.761, 0.401}}},
}};

/// The picture of Table 1 that contradicts the paper's text, counted from 0.
inline constexpr std::size_t kPublishedContradiction = 2;

/// Fig. 6: right answers per picture, percent.
inline constexpr std::array<int, 5> kPublishedPercents = {87, 72, 81, 91, 83};
inline constexpr int kPublishedPeople = 20;
inline constexpr int kPublishedTrials = 25;  ///< presentations per person
inline constexpr int kPublishedClasses = static_cast<int>(kPublishedPercents.size());
/// Presentations of one picture per person, if each picture is felt equally often.
inline constexpr int kPublishedTrialsOfClass = kPublishedTrials / kPublishedClasses;

/// The improvement of the average accuracy over TV-Gabor, 10 log10 of a ratio.
inline constexpr double kPublishedDecibel = 0.4;

/// The fixed orders whose textures are most similar to the adaptive one according to the paper.
inline constexpr double kPublishedLowestOrder = 0.5;
inline constexpr double kPublishedHighestOrder = 0.7;

}  // namespace touchtrial::analysis
