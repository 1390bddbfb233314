#pragma once

#include <string>
#include <string_view>

// Small pieces of the pages that commands write. Everything that is not the pages' own text goes through escape().
namespace likeness::page {

// Text for an element's content or a quoted attribute: & < > " ' become entities, control characters and bytes that
// are not UTF-8 become U+FFFD.
std::string escape(std::string_view text);

std::string base64(std::string_view bytes);

// "data:image/png;base64,..."
std::string png_data_url(std::string_view png);

// A number with so many significant digits, no exponent between 1e-4 and 1e6; "-" for NaN.
std::string number(double value, int digits = 3);

// A number as short as it can be said, up to 6 digits: 80, 0.5, 1e-05.
std::string plain(double value);

// A number with so many decimals; "-" for NaN.
std::string fixed(double value, int decimals);

// "<tag>text</tag>", the text escaped.
std::string element(std::string_view tag, std::string_view text);

// The parts of a page that all pages share: from the doctype to <body>, and the end. The title is escaped here.
std::string page_head(std::string_view title);
std::string page_foot();

}  // namespace likeness::page
