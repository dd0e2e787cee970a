#include <algorithm>
#include <array>
#include <stdexcept>
#include <utility>

#include "campaign.h"

namespace blindgen {

namespace {

constexpr std::array<std::pair<Kind, std::string_view>, 6> names{{{Kind::single, "single"},
                                                                  {Kind::null, "null"},
                                                                  {Kind::null_exact, "null_exact"},
                                                                  {Kind::pair, "pair"},
                                                                  {Kind::outside, "outside"},
                                                                  {Kind::rig, "rig"}}};

Origin origin_of(Kind kind) {
  if (kind == Kind::outside) return Origin::outside;
  return kind == Kind::rig ? Origin::rig : Origin::friction;
}

std::size_t number_hidden(Kind kind) {
  if (kind == Kind::null || kind == Kind::null_exact) return 0;
  return kind == Kind::pair ? 2 : 1;
}

/// In every block of as many cases as there are terms each comes once, in an order of its own.
const Term* next_of_block(const Spec& spec, const std::vector<const Term*>& terms) {
  const int count = static_cast<int>(terms.size());
  Stream order(spec.seed, static_cast<std::uint64_t>(spec.case_number / count),
               "order of " + std::string(name_of(spec.kind)));
  std::vector<const Term*> shuffled = terms;
  order.shuffle(shuffled);
  return shuffled[static_cast<std::size_t>(spec.case_number % count)];
}

std::vector<const Term*> drawn_terms(const Spec& spec) {
  const std::size_t count = number_hidden(spec.kind);
  std::vector<const Term*> terms = terms_of(origin_of(spec.kind));
  if (count == 0) return {};
  if (count == 1) return {next_of_block(spec, terms)};
  Stream stream(spec.seed, static_cast<std::uint64_t>(spec.case_number), "pair");
  stream.shuffle(terms);
  terms.resize(count);
  return terms;
}

std::vector<const Term*> asked_terms(const Spec& spec) {
  if (spec.effects.size() != number_hidden(spec.kind)) {
    throw std::invalid_argument("a case of kind " + std::string(name_of(spec.kind)) + " hides " +
                                std::to_string(number_hidden(spec.kind)) + " effects, not " +
                                std::to_string(spec.effects.size()));
  }
  std::vector<const Term*> terms;
  for (const std::string& id : spec.effects) {
    const Term* term = term_named(id);
    if (term == nullptr || term->origin != origin_of(spec.kind)) {
      throw std::invalid_argument("no effect " + id + " of kind " + std::string(name_of(spec.kind)));
    }
    terms.push_back(term);
  }
  return terms;
}

}  // namespace

std::optional<Kind> kind_named(std::string_view name) {
  for (const auto& [kind, text] : names) {
    if (text == name) return kind;
  }
  return std::nullopt;
}

std::string_view name_of(Kind kind) {
  return names[static_cast<std::size_t>(kind)].second;
}

Case draw_case(const Spec& spec) {
  const auto stream = [&](std::string what) {
    return Stream(spec.seed, static_cast<std::uint64_t>(spec.case_number),
                  what + " of " + std::string(name_of(spec.kind)));
  };
  Case drawn;
  Stream film = stream("film");
  drawn.world.melt = draw_melt(film, spec.kind == Kind::null_exact);
  drawn.world.curve = draw_curve(film, spec.kind == Kind::null_exact);
  for (const Term* term : spec.effects.empty() ? drawn_terms(spec) : asked_terms(spec)) {
    Stream shape = stream(std::string(term->id));
    drawn.hidden.push_back(hide(*term, spec.amplitude, shape, drawn.world));
  }
  return drawn;
}

}  // namespace blindgen
