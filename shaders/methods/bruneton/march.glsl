// The cells into which a path is cut for light of the second order and beyond. Their edges gather at the
// lowest point, where the air is thickest: at distances from it that grow with the cube of a number.

struct Cell {
  Real from_km;
  Real to_km;
};

Real cell_edge(Real length_km, Real lowest_km, int cells_down, int cells, int edge) {
  if (edge <= cells_down && cells_down > 0) {
    Real x = 1.0 - Real(edge) / Real(cells_down);
    return lowest_km * (1.0 - x * x * x);
  }
  Real x = Real(edge - cells_down) / Real(cells - cells_down);
  return lowest_km + (length_km - lowest_km) * (x * x * x);
}

// Of the cells those before the lowest point, on a path that goes on behind it.
int cells_before(Real lowest_km, Real length_km, int cells) {
  if (lowest_km <= 0.0) return 0;
  if (lowest_km >= length_km) return cells;
  Real before = sqrt(lowest_km);
  Real share = before / (before + sqrt(length_km - lowest_km));
  return clamp(int(Real(cells) * share + 0.5), 1, cells - 1);
}

Cell cell_of_path(Real h, Real mu, Real length_km, int cells, int i) {
  Real lowest_km = clamp(-(scene.planet_radius_km + h) * mu, 0.0, length_km);
  int before = cells_before(lowest_km, length_km, cells);
  Cell cell;
  cell.from_km = cell_edge(length_km, lowest_km, before, cells, i);
  cell.to_km = cell_edge(length_km, lowest_km, before, cells, i + 1);
  return cell;
}

// (1 - exp(-x)) / x: the share of what is emitted evenly over an optical depth that leaves it.
Vec4 escaping_share(Vec4 x) {
  Vec4 series = 1.0 - x * (0.5 - x * (1.0 / 6.0 - x / 24.0));
  Vec4 closed = (1.0 - exp(-x)) / max(x, Vec4(1e-9));
  Vec4 thick = step(Vec4(0.05), x);
  return series * (1.0 - thick) + closed * thick;
}

// The optical depths of extinction and scattering across a cell.
// @returns the mean place of what scatters in it, km from the ray's start
Real cross_cell(Real h, Real mu, Cell cell, OUT_ARRAY(Vec4, extinguished, GROUPS_SIZE),
                OUT_ARRAY(Vec4, scattered, GROUPS_SIZE)) {
  Real width_km = cell.to_km - cell.from_km;
  Real moment = 0.0;
  Real total = 0.0;
  UNROLL for (int g = 0; g < GROUPS; ++g) {
    extinguished[g] = Vec4(0.0);
    scattered[g] = Vec4(0.0);
  }
  UNROLL for (int i = 0; i < 4; ++i) {
    Real t = cell.from_km + width_km * gauss4_node(i);
    Real density[MEDIA_SIZE];
    densities(altitude_after(h, mu, t), density);
    Real here = 0.0;
    UNROLL for (int c = 0; c < MEDIA; ++c) {
      Real column = width_km * gauss4_weight(i) * density[c];
      UNROLL for (int g = 0; g < GROUPS; ++g) {
        Vec4 part = scattering(c, g) * column;
        extinguished[g] = extinguished[g] + extinction(c, g) * column;
        scattered[g] = scattered[g] + part;
        here += part.x + part.y + part.z + part.w;
      }
    }
    moment += here * t;
    total += here;
  }
  if (total <= 0.0) return 0.5 * (cell.from_km + cell.to_km);
  return clamp(moment / total, cell.from_km, cell.to_km);
}
