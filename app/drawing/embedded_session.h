#pragma once

#include <optional>
#include <string>
#include <string_view>

/// A session inside vector graphics: in an SVG as its metadata element, in a PDF as an attached file, which viewers
/// list and save, beside a page that stays as it is.
namespace tessera::app {

/// Name of the file attached to a PDF, and id of the element in an SVG.
inline constexpr std::string_view kAttachedSession = "tessera-session.json", kSessionElement = "tessera-session";

/// A text with the characters of XML escaped.
std::string escapedXml(std::string_view text);

/// The element, with its line end.
std::string sessionElement(std::string_view session);

/// The session in an SVG written by Tessera; nothing where there is none.
std::optional<std::string> sessionInSvg(std::string_view svg);

/// A PDF with a session attached, by an incremental update (ISO 32000-1, 7.5.6): what it holds stays byte for byte.
/// `pdf` has a cross-reference table, as cairo writes one up to PDF 1.4. Throws MachineError where it has not.
std::string withAttachedSession(std::string pdf, std::string_view session);

/// The session attached to a PDF written by Tessera; nothing where there is none. Throws Error naming `name` where it
/// is damaged.
std::optional<std::string> sessionInPdf(std::string_view pdf, const std::string& name);

} // namespace tessera::app
