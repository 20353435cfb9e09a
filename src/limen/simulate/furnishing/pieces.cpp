// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0
#include "limen/simulate/furnishing/pieces.h"

#include <algorithm>
#include <cmath>

#include "limen/geometry/random_vectors.h"
#include "limen/simulate/furnishing/shapes.h"

namespace limen {
namespace {

/// Builds one piece. `sizes` is the stream of its make, `things` that of what is on it.
struct Maker {
  ShapeBuilder& shape;
  Vector3d size;
  RandomStream& make;
  RandomStream& things;
};

void legs(Maker& m, const Vector2d& middle, const Vector2d& span, double height, double thick) {
  const bool round = m.make.uniform() < 0.5;
  for (const double x : {-0.5, 0.5}) {
    for (const double y : {-0.5, 0.5}) {
      const Vector3d foot(middle.x() + x * (span.x() - 2.0 * thick),
                          middle.y() + y * (span.y() - 2.0 * thick), 0.0);
      if (round)
        m.shape.cylinder(foot, 0.6 * thick, height, 0.7);
      else
        m.shape.box(foot, {thick, thick, height});
    }
  }
}

/// Something that lies on a top of the given size: a few bottles, books, bowls.
void things_on(Maker& m, const Vector3d& top_middle, const Vector2d& span, int most) {
  const int count = static_cast<int>(m.things.below(static_cast<std::uint32_t>(most + 1)));
  for (int i = 0; i < count; ++i) {
    const Vector2d share = uniform_vector(Vector2d(-0.4, -0.4), Vector2d(0.4, 0.4), m.things);
    const Vector3d at = top_middle + Vector3d(share.x() * span.x(), share.y() * span.y(), 0.0);
    const double form = m.things.uniform();
    if (form < 0.35) {
      const double reflectivity = m.things.uniform(0.4, 1.2);
      const double height = m.things.uniform(0.08, 0.32);
      m.shape.cylinder(at, m.things.uniform(0.03, 0.08), height, reflectivity);
    } else if (form < 0.75) {
      const double turn = m.things.uniform(0.0, 3.0);
      m.shape.box(
          at, {m.things.uniform(0.1, 0.35), m.things.uniform(0.08, 0.25), m.things.uniform(0.03, 0.3)}, turn);
    } else {
      m.shape.ellipsoid(at + Vector3d(0.0, 0.0, 0.08),
                        {m.things.uniform(0.06, 0.18), m.things.uniform(0.06, 0.15), 0.08});
    }
  }
}

void chair(Maker& m, const Vector2d& at, double facing, double seat) {
  const Vector2d back(-std::sin(facing), std::cos(facing));
  m.shape.box({at.x(), at.y(), seat - 0.04}, {0.42, 0.42, 0.04}, facing);
  for (const double x : {-0.18, 0.18})
    for (const double y : {-0.18, 0.18}) {
      const Vector2d foot = at + x * Vector2d(back.y(), -back.x()) + y * back;
      m.shape.cylinder({foot.x(), foot.y(), 0.0}, 0.018, seat - 0.03);
    }
  const Vector2d rest = at + 0.2 * back;
  m.shape.box({rest.x(), rest.y(), seat}, {0.4, 0.025, 0.44}, facing);
}

void cupboard(Maker& m) {
  m.shape.box({0.0, 0.5 * m.size.y(), 0.0}, m.size);
  // Handles and a plinth's shadow: small, but not a plain box.
  const int doors = std::max(1, static_cast<int>(m.size.x() / 0.5));
  for (int i = 0; i < doors; ++i) {
    const double x = m.size.x() * ((i + 0.5) / doors - 0.5);
    m.shape.box({x + 0.12, m.size.y() + 0.015, 0.5 * m.size.z()}, {0.02, 0.03, 0.16});
  }
  if (m.size.z() < 1.9) things_on(m, {0.0, 0.5 * m.size.y(), m.size.z()}, {m.size.x(), m.size.y()}, 3);
}

void open_shelf(Maker& m) {
  const double w = m.size.x();
  const double d = m.size.y();
  const double h = m.size.z();
  if (m.make.uniform() < 0.6) m.shape.box({0.0, 0.01, 0.0}, {w, 0.02, h});
  for (const double side : {-0.5, 0.5}) m.shape.box({side * (w - 0.025), 0.5 * d, 0.0}, {0.025, d, h});
  const int boards = 3 + static_cast<int>(m.make.below(4));
  const double step = (h - 0.025) / boards;
  for (int i = 0; i <= boards; ++i) {
    m.shape.box({0.0, 0.5 * d, i * step}, {w - 0.05, d, 0.025});
    if (i == boards) break;
    double x = -0.5 * w + 0.05;
    while (x < 0.5 * w - 0.2) {
      const double wide = m.things.uniform(0.06, 0.35);
      const double high = step * m.things.uniform(0.3, 0.85);
      const Vector3d at(x + 0.5 * wide, d * m.things.uniform(0.4, 0.6), i * step + 0.025);
      if (m.things.uniform() < 0.25)
        m.shape.cylinder(at, std::min(0.4 * wide, 0.1), high);
      else if (m.things.uniform() < 0.8)
        m.shape.box(at, {wide, d * m.things.uniform(0.4, 0.75), high});
      x += wide + (m.things.uniform() < 0.5 ? 0.01 : m.things.uniform(0.05, 0.3));
    }
  }
}

void bed(Maker& m) {
  const double w = m.size.x();
  m.shape.box({0.0, 0.5 * m.size.y(), 0.1}, {w, m.size.y(), 0.22});
  m.shape.box({0.0, 0.03, 0.0}, {w, 0.06, m.size.z()});
  m.shape.ellipsoid({0.0, 0.52 * m.size.y(), 0.38}, {0.54 * w, 0.52 * m.size.y(), 0.16});
  const int pillows = w > 1.3 ? 2 : 1;
  for (int i = 0; i < pillows; ++i)
    m.shape.ellipsoid({w * ((i + 0.5) / pillows - 0.5), 0.32, 0.56},
                      {0.34, 0.22, 0.1 + 0.03 * m.things.uniform()});
}

void sofa(Maker& m) {
  const double w = m.size.x();
  const double d = m.size.y();
  m.shape.box({0.0, 0.5 * d, 0.06}, {w - 0.3, d, 0.26});
  m.shape.box({0.0, 0.11, 0.0}, {w, 0.22, m.size.z() - 0.08});
  for (const double side : {-1.0, 1.0}) {
    m.shape.box({side * (0.5 * w - 0.09), 0.5 * d, 0.0}, {0.18, d, 0.5});
    m.shape.ellipsoid({side * (0.5 * w - 0.09), 0.5 * d, 0.5}, {0.12, 0.5 * d, 0.09});
  }
  const int seats = std::max(1, static_cast<int>((w - 0.3) / 0.6));
  for (int i = 0; i < seats; ++i) {
    const double x = (w - 0.36) * ((i + 0.5) / seats - 0.5);
    m.shape.ellipsoid({x, 0.55 * d + 0.08, 0.36}, {0.52 * (w - 0.36) / seats, 0.4 * d, 0.1});
    m.shape.ellipsoid({x + m.things.uniform(-0.05, 0.05), 0.27, 0.6}, {0.45 * (w - 0.36) / seats, 0.1, 0.2});
  }
}

void desk(Maker& m) {
  const double w = m.size.x();
  const double d = m.size.y();
  const double h = 0.74;
  m.shape.box({0.0, 0.5 * d, h - 0.03}, {w, d, 0.03});
  legs(m, {0.0, 0.5 * d}, {w, d}, h - 0.03, 0.05);
  const double side = m.make.uniform() < 0.5 ? -1.0 : 1.0;
  m.shape.box({side * (0.5 * w - 0.25), 0.5 * d, 0.05}, {0.4, 0.8 * d, 0.55});
  const double x = m.things.uniform(-0.2, 0.2) * w;
  m.shape.cylinder({x, 0.3 * d, h}, 0.1, 0.015);
  m.shape.cylinder({x, 0.27 * d, h}, 0.025, 0.25);
  const double turn = m.things.uniform(-0.3, 0.3);
  m.shape.box({x, 0.3 * d, h + 0.13}, {m.make.uniform(0.5, 0.8), 0.03, 0.36}, turn);
  things_on(m, {0.0, 0.6 * d, h}, {w, 0.6 * d}, 5);
}

void table_with_chairs(Maker& m) {
  const double reach = 0.5;
  const double w = m.size.x() - 2.0 * reach;
  const double d = m.size.y() - 2.0 * reach;
  const double h = m.make.uniform(0.71, 0.77);
  const Vector2d middle(0.0, 0.5 * m.size.y());
  m.shape.box({0.0, middle.y(), h - 0.035}, {w, d, 0.035});
  legs(m, middle, {w, d}, h - 0.035, m.make.uniform(0.05, 0.09));
  const int chairs = std::max(1, static_cast<int>(w / 0.65));
  for (int i = 0; i < chairs; ++i) {
    for (const double side : {-1.0, 1.0}) {
      if (m.things.uniform() < 0.15) continue;
      const Vector2d off = uniform_vector(Vector2d(-0.06, -0.1), Vector2d(0.06, 0.22), m.things);
      const Vector2d at =
          middle + Vector2d(w * ((i + 0.5) / chairs - 0.5) + off.x(), side * (0.5 * d + off.y()));
      chair(m, at, (side > 0.0 ? 0.0 : 3.14159) + m.things.uniform(-0.35, 0.35), 0.45);
    }
  }
  things_on(m, {0.0, middle.y(), h}, {w, d}, 6);
}

void round_table(Maker& m) {
  const double r = 0.5 * m.size.x() - 0.5;
  const Vector2d middle(0.0, 0.5 * m.size.y());
  m.shape.cylinder({0.0, middle.y(), 0.0}, 0.3, 0.04, 0.3);
  m.shape.cylinder({0.0, middle.y(), 0.0}, 0.045, 0.7);
  m.shape.cylinder({0.0, middle.y(), 0.7}, r, 0.035);
  const int chairs = 2 + static_cast<int>(m.make.below(3));
  const double turn = m.make.uniform(0.0, 6.28);
  for (int i = 0; i < chairs; ++i) {
    const double a = turn + 6.28318 * i / chairs + m.things.uniform(-0.25, 0.25);
    const Vector2d at = middle + (r + m.things.uniform(-0.1, 0.15)) * Vector2d(std::cos(a), std::sin(a));
    chair(m, at, a - 1.5708 + m.things.uniform(-0.3, 0.3), 0.45);
  }
  things_on(m, {0.0, middle.y(), 0.735}, {r, r}, 4);
}

void office_chair(Maker& m) {
  const double y = 0.5 * m.size.y();
  const double turn = m.things.uniform(0.0, 6.28);
  for (int i = 0; i < 5; ++i) {
    const double a = turn + 6.28318 * i / 5.0;
    m.shape.box({0.15 * std::cos(a), y + 0.15 * std::sin(a), 0.04}, {0.3, 0.05, 0.04}, a);
  }
  m.shape.cylinder({0.0, y, 0.05}, 0.03, 0.38);
  m.shape.ellipsoid({0.0, y, 0.48}, {0.25, 0.25, 0.06});
  const Vector2d back(0.22 * std::cos(turn), 0.22 * std::sin(turn));
  m.shape.ellipsoid({back.x(), y + back.y(), 0.78},
                    {0.12 + 0.12 * std::abs(std::sin(turn)), 0.12 + 0.12 * std::abs(std::cos(turn)), 0.26});
}

void plant(Maker& m) {
  const double y = 0.5 * m.size.y();
  const double r = 0.5 * m.size.x();
  m.shape.cylinder({0.0, y, 0.0}, 0.45 * r, 0.32, 1.3);
  m.shape.cylinder({0.0, y, 0.3}, 0.025, 0.5 * m.size.z());
  m.shape.leaves({0.0, y, 0.65 * m.size.z()}, {r, r, 0.34 * m.size.z()},
                 static_cast<int>(260.0 * m.size.z() * r * 2.0), m.things);
}

void statue(Maker& m) {
  const double y = 0.5 * m.size.y();
  const double plinth = 0.45 * m.size.z();
  const double w = 0.8 * m.size.x();
  m.shape.box({0.0, y, 0.0}, {w, w, plinth});
  const double body = m.size.z() - plinth;
  m.shape.ellipsoid({0.0, y, plinth + 0.35 * body}, {0.28 * w, 0.22 * w, 0.35 * body});
  m.shape.ellipsoid({m.make.uniform(-0.1, 0.1) * w, y, plinth + 0.82 * body},
                    {0.14 * w, 0.16 * w, 0.16 * body});
  m.shape.ellipsoid({m.make.uniform(0.2, 0.35) * w, y, plinth + 0.5 * body},
                    {0.07 * w, 0.07 * w, 0.3 * body});
}

void display_case(Maker& m) {
  const double table = 0.6 * m.size.z();
  m.shape.box({0.0, 0.5 * m.size.y(), table - 0.2}, {m.size.x(), m.size.y(), 0.2});
  legs(m, {0.0, 0.5 * m.size.y()}, {m.size.x(), m.size.y()}, table - 0.2, 0.06);
  things_on(m, {0.0, 0.5 * m.size.y(), table}, {m.size.x(), m.size.y()}, 6);
  const double x = m.make.uniform(-0.2, 0.2) * m.size.x();
  m.shape.ellipsoid({x, 0.5 * m.size.y(), table + 0.2 * m.size.z()}, {0.18, 0.13, 0.2 * m.size.z()});
}

void piano(Maker& m) {
  m.shape.box({0.0, 0.19, 0.0}, {m.size.x(), 0.38, m.size.z()});
  m.shape.box({0.0, 0.5, 0.6}, {m.size.x(), 0.28, 0.12});
  for (const double side : {-0.45, 0.45}) m.shape.cylinder({side * m.size.x(), 0.58, 0.0}, 0.03, 0.6);
  m.shape.leaning_board({0.0, 0.4, 0.95}, 0.6, 0.3, 0.3);
}

void kitchen_row(Maker& m) {
  m.shape.box({0.0, 0.5 * m.size.y(), 0.1}, {m.size.x(), m.size.y() - 0.04, 0.76});
  m.shape.box({0.0, 0.5 * m.size.y(), 0.86}, {m.size.x(), m.size.y(), 0.04});
  m.shape.box({0.0, 0.17, 1.42}, {m.size.x(), 0.34, m.size.z() - 1.42});
  m.shape.cylinder({m.make.uniform(-0.3, 0.3) * m.size.x(), 0.2, 0.9}, 0.015, 0.28);
  things_on(m, {0.0, 0.45, 0.9}, {m.size.x(), 0.3}, 7);
}

void box_pile(Maker& m) {
  double z = 0.0;
  while (z < m.size.z() - 0.15) {
    const double h = m.things.uniform(0.2, 0.4);
    const double turn = m.things.uniform(-0.2, 0.2);
    const Vector3d size = {m.size.x() * m.things.uniform(0.6, 0.85), m.size.y() * m.things.uniform(0.6, 0.85),
                           h};
    m.shape.box({m.things.uniform(-0.08, 0.08), 0.5 * m.size.y(), z}, size, turn);
    z += h;
  }
}

void slender(Maker& m, bool lamp) {
  const double y = 0.5 * m.size.y();
  m.shape.cylinder({0.0, y, 0.0}, 0.45 * m.size.x(), 0.03);
  m.shape.cylinder({0.0, y, 0.0}, 0.016, m.size.z() - 0.1);
  if (lamp) {
    m.shape.cylinder({0.0, y, m.size.z() - 0.3}, 0.5 * m.size.x(), 0.3, 0.6);
    return;
  }
  const int coats = static_cast<int>(m.things.below(4));
  for (int i = 0; i < coats; ++i) {
    const double a = m.things.uniform(0.0, 6.28);
    m.shape.ellipsoid({0.12 * std::cos(a), y + 0.12 * std::sin(a), 0.72 * m.size.z()}, {0.16, 0.12, 0.42});
  }
}

void bicycle(Maker& m) {
  for (const double side : {-0.3, 0.3})
    m.shape.ellipsoid({side * m.size.x(), 0.25, 0.34}, {0.33, 0.02, 0.33});
  m.shape.box({0.0, 0.25, 0.5}, {0.55 * m.size.x(), 0.04, 0.05});
  m.shape.box({-0.1, 0.25, 0.3}, {0.04, 0.04, 0.6});
  m.shape.box({0.25 * m.size.x(), 0.25, 1.0}, {0.05, 0.5, 0.03});
}

void radiator(Maker& m) {
  const int ribs = std::max(2, static_cast<int>(m.size.x() / 0.09));
  for (int i = 0; i < ribs; ++i)
    m.shape.box({m.size.x() * ((i + 0.5) / ribs - 0.5), 0.5 * m.size.y() + 0.02, 0.12},
                {0.05, m.size.y() - 0.03, m.size.z() - 0.12});
  m.shape.box({0.0, 0.5 * m.size.y() + 0.02, 0.15}, {m.size.x(), 0.04, 0.05});
}

void small_object(Maker& m) {
  const double y = 0.5 * m.size.y();
  const double form = m.make.uniform();
  if (form < 0.3)
    m.shape.box({0.0, y, 0.0}, m.size, m.make.uniform(0.0, 1.5));
  else if (form < 0.6)
    m.shape.cylinder({0.0, y, 0.0}, 0.5 * m.size.x(), m.size.z(), m.make.uniform(0.6, 1.2));
  else
    m.shape.ellipsoid({0.0, y, 0.5 * m.size.z()}, 0.5 * m.size);
}

void hanging_lamp(Maker& m) {
  const double y = 0.5 * m.size.y();
  if (m.make.uniform() < 0.5) {
    m.shape.box({0.0, y, 0.0}, {m.size.x(), m.size.y(), 0.08});
    m.shape.box({0.0, y, 0.08}, {0.02, 0.02, m.size.z() - 0.08});
  } else {
    m.shape.cylinder({0.0, y, 0.0}, 0.5 * m.size.y(), 0.16, 0.4);
    m.shape.cylinder({0.0, y, 0.16}, 0.01, m.size.z() - 0.16);
  }
}

void build(Maker& m, PieceKind kind) {
  switch (kind) {
    case PieceKind::open_shelf:
      return open_shelf(m);
    case PieceKind::bed:
      return bed(m);
    case PieceKind::sofa:
    case PieceKind::armchair:
      return sofa(m);
    case PieceKind::desk:
      return desk(m);
    case PieceKind::piano:
      return piano(m);
    case PieceKind::kitchen_row:
      return kitchen_row(m);
    case PieceKind::dining_table:
      return table_with_chairs(m);
    case PieceKind::round_table:
      return round_table(m);
    case PieceKind::office_chair:
      return office_chair(m);
    case PieceKind::plant:
      return plant(m);
    case PieceKind::floor_lamp:
    case PieceKind::coat_stand:
      return slender(m, kind == PieceKind::floor_lamp);
    case PieceKind::box_pile:
      return box_pile(m);
    case PieceKind::display_case:
      return display_case(m);
    case PieceKind::statue:
      return statue(m);
    case PieceKind::bicycle:
      return bicycle(m);
    case PieceKind::picture:
      return m.shape.box({0.0, 0.5 * m.size.y(), 0.0}, m.size);
    case PieceKind::radiator:
      return radiator(m);
    case PieceKind::ceiling_lamp:
      return hanging_lamp(m);
    case PieceKind::small_object:
      return small_object(m);
    default:
      return cupboard(m);
  }
}

}  // namespace

void add_piece(Mesh& mesh, const Piece& piece, const PiecePlace& place) {
  RandomStream make(piece.seed, 2);
  RandomStream things(piece.contents_seed, 3);
  ShapeBuilder shape(mesh, place.back, place.along, make.uniform(0.2, 0.8));
  Maker maker{shape, size_of(piece), make, things};
  build(maker, piece.kind);
}

}  // namespace limen
