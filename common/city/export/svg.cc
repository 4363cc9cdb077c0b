#include "common/city/export/svg.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <utility>
#include <vector>

#include "common/city/export/height_classes.h"
#include "common/city/export/street_labels.h"

namespace cuscus::city {
namespace {

// Of the picture, in its own units.
constexpr double kLongSide = 1000.0;
constexpr double kMargin = 20.0;
constexpr double kTitle = 50.0;
constexpr double kLegend = 170.0;
constexpr double kFooter = 50.0;

using Colour = std::array<double, 3>;
// From low to high: light sand, ochre, red, dark violet. Lightness falls all the way, so that it
// prints in grey as well.
constexpr std::array<Colour, 5> kRamp{
    {{248, 230, 190}, {240, 185, 110}, {214, 110, 76}, {140, 46, 92}, {52, 16, 72}}};

std::string colour(double part) {
  const double at = std::clamp(part, 0.0, 1.0) * (kRamp.size() - 1);
  const auto low = std::min(static_cast<std::size_t>(at), kRamp.size() - 2);
  std::array<int, 3> mixed{};
  for (std::size_t i = 0; i < mixed.size(); ++i) {
    const double value =
        kRamp[low][i] + (kRamp[low + 1][i] - kRamp[low][i]) * (at - static_cast<double>(low));
    mixed[i] = static_cast<int>(std::lround(value));
  }
  return fmt::format("#{:02x}{:02x}{:02x}", mixed[0], mixed[1], mixed[2]);
}

std::string xml_text(const std::string& text) {
  std::string result;
  for (const char letter : text) {
    if (letter == '&') {
      result += "&amp;";
    } else if (letter == '<') {
      result += "&lt;";
    } else if (letter == '>') {
      result += "&gt;";
    } else if (static_cast<unsigned char>(letter) >= ' ') {
      result += letter;  // XML 1.0 has no other control characters
    }
  }
  return result;
}

class Picture {
 public:
  Picture(const City& city, const MapLabels& labels)
      : city_{city},
        labels_{labels},
        extent_m_{(city.north_east_m - city.south_west_m).cwiseMax(1.0)},
        units_per_m_{kLongSide / extent_m_.maxCoeff()},
        size_{extent_m_ * units_per_m_},
        classes_{city} {}

  std::string text() {
    const double width = size_.x() + 3.0 * kMargin + kLegend;
    const double height = std::max(size_.y(), 330.0) + kTitle + kFooter + kMargin;
    add("<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0:.0f}\" height=\"{1:.0f}\" "
        "viewBox=\"0 0 {0:.0f} {1:.0f}\" font-family=\"sans-serif\">\n",
        width, height);
    add("<rect width=\"{:.0f}\" height=\"{:.0f}\" fill=\"#ffffff\"/>\n", width, height);
    add("<text x=\"{}\" y=\"32\" font-size=\"20\">{}</text>\n", kMargin, xml_text(labels_.title));
    add("<clipPath id=\"area\"><rect width=\"{:.2f}\" height=\"{:.2f}\"/></clipPath>\n", size_.x(),
        size_.y());
    add("<g transform=\"translate({},{})\" clip-path=\"url(#area)\">\n", kMargin, kTitle);
    add("<rect width=\"{:.2f}\" height=\"{:.2f}\" fill=\"#e9e6df\"/>\n", size_.x(), size_.y());
    draw_woods();
    draw_streets();
    draw_buildings();
    draw_trees();
    draw_names();
    out_ += "</g>\n";
    add("<rect x=\"{}\" y=\"{}\" width=\"{:.2f}\" height=\"{:.2f}\" fill=\"none\" "
        "stroke=\"#4a4038\" stroke-width=\"0.5\"/>\n",
        kMargin, kTitle, size_.x(), size_.y());
    draw_legend();
    draw_scale_and_attribution();
    return std::move(out_) + "</svg>\n";
  }

 private:
  template <typename... Arguments>
  void add(fmt::format_string<Arguments...> format, Arguments&&... arguments) {
    fmt::format_to(std::back_inserter(out_), format, std::forward<Arguments>(arguments)...);
  }

  [[nodiscard]] std::string point(const Eigen::Vector2d& p_m) const {
    return fmt::format("{:.2f} {:.2f}", (p_m.x() - city_.south_west_m.x()) * units_per_m_,
                       (city_.north_east_m.y() - p_m.y()) * units_per_m_);
  }

  [[nodiscard]] std::string path(const std::vector<Eigen::Vector2d>& points, bool closed) const {
    std::string text;
    for (const Eigen::Vector2d& p : points) {
      text += (text.empty() ? "M" : "L") + point(p);
    }
    return closed ? text + "Z" : text;
  }

  [[nodiscard]] std::string area(const Footprint& footprint) const {
    std::string text = path(footprint.outer, true);
    for (const Ring& courtyard : footprint.courtyards) {
      text += path(courtyard, true);
    }
    return text;
  }

  [[nodiscard]] std::string class_colour(std::size_t number) const {
    const auto last = static_cast<double>(std::max<std::size_t>(classes_.count() - 1, 1));
    return colour(static_cast<double>(number) / last);
  }

  void draw_woods() {
    for (const Wood& wood : city_.woods) {
      add("<path d=\"{}\" fill=\"#b9d3a4\" fill-rule=\"evenodd\"/>\n", area(wood.footprint));
    }
  }

  void draw_streets() {
    out_ +=
        "<g fill=\"none\" stroke=\"#ffffff\" stroke-linecap=\"round\" "
        "stroke-linejoin=\"round\">\n";
    for (const Street& street : city_.streets) {
      add("<path d=\"{}\" stroke-width=\"{:.2f}\"/>\n", path(street.axis_m, false),
          std::max(street.width_m * units_per_m_, 0.5));
    }
    out_ += "</g>\n";
  }

  /// The higher ones last, so that towers are seen on what they stand on.
  void draw_buildings() {
    std::vector<const Prism*> prisms;
    for (const Building& building : city_.buildings) {
      for (const Prism& prism : building.prisms) {
        prisms.push_back(&prism);
      }
    }
    std::stable_sort(prisms.begin(), prisms.end(),
                     [](const Prism* a, const Prism* b) { return a->top_m < b->top_m; });
    add("<g stroke=\"#4a4038\" stroke-width=\"{:.2f}\" fill-rule=\"evenodd\">\n",
        std::clamp(0.3 * units_per_m_, 0.15, 0.8));
    for (const Prism* prism : prisms) {
      add("<path d=\"{}\" fill=\"{}\"/>\n", area(prism->footprint),
          class_colour(classes_.class_of(prism->top_m)));
    }
    out_ += "</g>\n";
  }

  void draw_trees() {
    out_ += "<g fill=\"#4f8a3c\" fill-opacity=\"0.65\">\n";
    for (const Tree& tree : city_.trees) {
      add("<circle transform=\"translate({})\" r=\"{:.2f}\"/>\n", point(tree.foot_m.head<2>()),
          std::max(tree.crown_radius_m * units_per_m_, 0.8));
    }
    out_ += "</g>\n";
  }

  void draw_names() {
    out_ +=
        "<g fill=\"#333333\" text-anchor=\"middle\" stroke=\"#ffffff\" stroke-width=\"1.5\" "
        "paint-order=\"stroke\">\n";
    for (const StreetLabel& label : street_labels(city_, units_per_m_)) {
      // Down by a third of the letters: their middle is on the axis then.
      add("<text transform=\"translate({:.2f} {:.2f}) rotate({:.2f})\" y=\"{:.2f}\" "
          "font-size=\"{:.2f}\">{}</text>\n",
          label.middle.x(), label.middle.y(), label.angle_deg, 0.35 * label.size, label.size,
          xml_text(label.name));
    }
    out_ += "</g>\n";
  }

  void draw_legend() {
    const double x = size_.x() + 2.0 * kMargin;
    add("<g transform=\"translate({:.2f} {:.2f})\" font-size=\"13\">\n", x, kTitle);
    out_ +=
        "<path d=\"M14 0L24 34L14 27L4 34Z\" fill=\"#333333\"/>\n"
        "<text x=\"14\" y=\"50\" text-anchor=\"middle\">N</text>\n"
        "<text y=\"85\">height of roofs</text>\n";
    double y = 95.0;
    constexpr double kRow = 22.0;
    for (std::size_t i = classes_.count(); i-- > 0; y += kRow) {
      add("<rect y=\"{:.0f}\" width=\"26\" height=\"16\" fill=\"{}\" stroke=\"#4a4038\" "
          "stroke-width=\"0.5\"/><text x=\"34\" y=\"{:.0f}\">{}</text>\n",
          y, class_colour(i), y + 13.0, classes_.label(i));
    }
    if (!city_.woods.empty()) {
      add("<rect y=\"{:.0f}\" width=\"26\" height=\"16\" fill=\"#b9d3a4\"/>"
          "<text x=\"34\" y=\"{:.0f}\">wood</text>\n",
          y, y + 13.0);
      y += kRow;
    }
    if (!city_.trees.empty()) {
      add("<circle cx=\"13\" cy=\"{:.0f}\" r=\"6\" fill=\"#4f8a3c\" fill-opacity=\"0.65\"/>"
          "<text x=\"34\" y=\"{:.0f}\">tree</text>\n",
          y + 8.0, y + 13.0);
      y += kRow;
    }
    add("<text y=\"{:.0f}\">buildings: {}</text>\n", y + 22.0, city_.buildings.size());
    add("<text y=\"{:.0f}\">{:.0f} m x {:.0f} m</text>\n</g>\n", y + 42.0, extent_m_.x(),
        extent_m_.y());
  }

  void draw_scale_and_attribution() {
    const double bar_m = round_step(extent_m_.x() / 12.0);
    const double y = kTitle + std::max(size_.y(), 330.0) + 18.0;
    add("<g transform=\"translate({} {:.2f})\" font-size=\"12\">\n", kMargin, y);
    add("<path d=\"M0 -5V0H{0:.2f}V-5\" fill=\"none\" stroke=\"#333333\" "
        "stroke-width=\"1.5\"/><text x=\"{1:.2f}\" y=\"2\">{2:g} m</text>\n",
        bar_m * units_per_m_, bar_m * units_per_m_ + 6.0, bar_m);
    if (!labels_.attribution.empty()) {
      add("<text y=\"24\" fill=\"#555555\">{}</text>\n", xml_text(labels_.attribution));
    }
    out_ += "</g>\n";
  }

  const City& city_;
  const MapLabels& labels_;
  Eigen::Vector2d extent_m_;
  double units_per_m_;
  Eigen::Vector2d size_;
  HeightClasses classes_;
  std::string out_;
};

}  // namespace

std::string svg_text(const City& city, const MapLabels& labels) {
  return Picture{city, labels}.text();
}

}  // namespace cuscus::city
