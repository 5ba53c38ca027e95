// SPDX-License-Identifier: Apache-2.0
// The falloff functions rho(t), t = d / d_max: how much of the ambient light comes through from an occluder
// at distance d. Mendez, Sbert, Neumann 2003 name the square root and the negative exponential; the other
// shapes are those of the same group's later programs.
#include "scene/settings.h"

#include "base/error.h"

#include <charconv>
#include <cmath>

namespace obscura {

namespace {

constexpr const char* KNOWN_NAMES =
    "step, linear, sqrt, cbrt, exp, exp:LAMBDA (LAMBDA > 0), expjump, pow:P (P > 0)";

std::optional<double> parse_positive(const std::string& text) {
    double value = 0;
    const char* end = text.data() + text.size();
    const auto [stop, error] = std::from_chars(text.data(), end, value);
    if (error != std::errc() || stop != end || !std::isfinite(value) || value <= 0) return std::nullopt;
    return value;
}

}  // namespace

double falloff_value(const Falloff& falloff, double t) {
    if (t >= 1) return 1;
    // expm1 instead of 1 - exp: keeps all digits near contact, where t is tiny.
    switch (falloff.kind) {
        case FalloffKind::step:
            return 0;
        case FalloffKind::linear:
            return t;
        case FalloffKind::sqrt:
            return std::sqrt(t);
        case FalloffKind::cbrt:
            return std::cbrt(t);
        case FalloffKind::exp:
            return std::expm1(-falloff.parameter * t) / std::expm1(-falloff.parameter);
        case FalloffKind::expjump:
            return -std::expm1(-t);
        case FalloffKind::pow:
            return std::pow(t, falloff.parameter);
    }
    OBSCURA_CHECK(false, "falloff kind {}", static_cast<uint32_t>(falloff.kind));
}

Falloff parse_falloff(const std::string& text) {
    if (text == "step") return {FalloffKind::step, 1};
    if (text == "linear") return {FalloffKind::linear, 1};
    if (text == "sqrt") return {FalloffKind::sqrt, 1};
    if (text == "cbrt") return {FalloffKind::cbrt, 1};
    if (text == "exp") return {FalloffKind::exp, 1};
    if (text == "expjump") return {FalloffKind::expjump, 1};
    for (const auto& [prefix, kind] : {std::pair{"exp:", FalloffKind::exp}, {"pow:", FalloffKind::pow}}) {
        if (!text.starts_with(prefix)) continue;
        if (const auto parameter = parse_positive(text.substr(4))) return {kind, *parameter};
        throw InputError("--rho {}: the part after the colon must be a positive number.", text);
    }
    throw InputError("--rho {}: not a falloff function. Known are {}.", text, KNOWN_NAMES);
}

std::string falloff_text(const Falloff& falloff) {
    switch (falloff.kind) {
        case FalloffKind::step:
            return "step";
        case FalloffKind::linear:
            return "linear";
        case FalloffKind::sqrt:
            return "sqrt";
        case FalloffKind::cbrt:
            return "cbrt";
        case FalloffKind::exp:
            return falloff.parameter == 1 ? "exp" : fmt::format("exp:{}", falloff.parameter);
        case FalloffKind::expjump:
            return "expjump";
        case FalloffKind::pow:
            return fmt::format("pow:{}", falloff.parameter);
    }
    OBSCURA_CHECK(false, "falloff kind {}", static_cast<uint32_t>(falloff.kind));
}

}  // namespace obscura
