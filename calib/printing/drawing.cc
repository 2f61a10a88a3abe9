#include "calib/printing/drawing.h"

#include <fmt/format.h>

namespace glint {
namespace {

constexpr double kPoint_mm = 25.4 / 72;

// PDF knows no exponents; a hundredth of a micrometre is enough.
std::string Number(double value) {
  std::string text = fmt::format("{:.5f}", value);
  text.erase(text.find_last_not_of('0') + 1);
  if (text.back() == '.') text.pop_back();
  return text == "-0" ? "0" : text;
}

std::string PdfText(const std::string& text) {
  std::string escaped;
  for (const char c : text) {
    if (c == '(' || c == ')' || c == '\\') escaped += '\\';
    escaped += c >= ' ' && c <= '~' ? c : '?';
  }
  return "(" + escaped + ")";
}

std::string XmlText(const std::string& text) {
  std::string escaped;
  for (const char c : text) {
    if (c == '&') {
      escaped += "&amp;";
    } else if (c == '<') {
      escaped += "&lt;";
    } else {
      escaped += c >= ' ' && c <= '~' ? c : '?';
    }
  }
  return escaped;
}

std::string PdfContent(const Drawing& drawing) {
  std::string text = fmt::format("{0} 0 0 {0} 0 0 cm\n", fmt::format("{:.12f}", 1 / kPoint_mm));
  for (const FilledShape& shape : drawing.shapes) {
    text += Number(shape.level / 255.0) + " g\n";
    for (const auto& polygon : shape.polygons) {
      for (size_t i = 0; i < polygon.size(); ++i) {
        text += Number(polygon[i].x()) + " " + Number(polygon[i].y()) + (i == 0 ? " m " : " l ");
      }
      text += "h\n";
    }
    text += "f\n";
  }
  text += "0 g\n";
  for (const TextLine& line : drawing.lines) {
    text += "BT /F1 " + Number(line.size_mm) + " Tf " + Number(line.start_mm.x()) + " " +
            Number(line.start_mm.y()) + " Td " + PdfText(line.text) + " Tj ET\n";
  }
  return text;
}

}  // namespace

std::vector<Eigen::Vector2d> Rectangle(double left, double bottom, double right, double top) {
  return {{left, bottom}, {right, bottom}, {right, top}, {left, top}};
}

double TextWidth(const std::string& text) { return 0.52 * static_cast<double>(text.size()); }

std::string PdfOf(const Drawing& drawing) {
  const std::string content = PdfContent(drawing);
  const std::string objects[] = {
      "<< /Type /Catalog /Pages 2 0 R /ViewerPreferences << /PrintScaling /None >> >>",
      "<< /Type /Pages /Kids [3 0 R] /Count 1 >>",
      "<< /Type /Page /Parent 2 0 R /MediaBox [0 0 " + Number(drawing.width_mm / kPoint_mm) + " " +
          Number(drawing.height_mm / kPoint_mm) +
          "] /Resources << /Font << /F1 5 0 R >> >> /Contents 4 0 R >>",
      fmt::format("<< /Length {} >>\nstream\n{}endstream", content.size(), content),
      "<< /Type /Font /Subtype /Type1 /BaseFont /Helvetica >>",
      "<< /Title " + PdfText(drawing.title) + " /Producer (Glint) >>"};
  std::string pdf = "%PDF-1.6\n%\xE2\xE3\xCF\xD3\n";
  std::string table = "0000000000 65535 f \n";
  int number = 0;
  for (const std::string& object : objects) {
    table += fmt::format("{:010} 00000 n \n", pdf.size());
    pdf += fmt::format("{} 0 obj\n{}\nendobj\n", ++number, object);
  }
  const size_t start = pdf.size();
  pdf += fmt::format(
      "xref\n0 {0}\n{1}trailer\n<< /Size {0} /Root 1 0 R /Info 6 0 R >>\nstartxref\n{2}\n%%EOF\n",
      number + 1, table, start);
  return pdf;
}

std::string SvgOf(const Drawing& drawing) {
  const std::string w = Number(drawing.width_mm), h = Number(drawing.height_mm);
  std::string svg = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0}mm\" height=\"{1}mm\" "
      "viewBox=\"0 0 {0} {1}\">\n<title>{2}</title>\n"
      "<rect width=\"{0}\" height=\"{1}\" fill=\"#fff\"/>\n",
      w, h, XmlText(drawing.title));
  const auto y = [&](double up_mm) { return Number(drawing.height_mm - up_mm); };
  for (const FilledShape& shape : drawing.shapes) {
    svg += fmt::format("<path fill=\"#{0:02x}{0:02x}{0:02x}\" d=\"", shape.level);
    for (const auto& polygon : shape.polygons) {
      for (size_t i = 0; i < polygon.size(); ++i) {
        svg += (i == 0 ? "M" : "L") + Number(polygon[i].x()) + " " + y(polygon[i].y());
      }
      svg += "Z\n";
    }
    svg += "\"/>\n";
  }
  for (const TextLine& line : drawing.lines) {
    svg += fmt::format(
        "<text x=\"{}\" y=\"{}\" font-size=\"{}\" "
        "font-family=\"Helvetica, Arial, sans-serif\">{}</text>\n",
        Number(line.start_mm.x()), y(line.start_mm.y()), Number(line.size_mm), XmlText(line.text));
  }
  return svg + "</svg>\n";
}

}  // namespace glint
