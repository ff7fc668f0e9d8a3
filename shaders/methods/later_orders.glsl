// All orders after the last one that was traced. Under one sun they are, after a few, a sum of modes over
// altitude, each of which fades by its own share an order: in thin air one mode that is soon gone, in thick air
// several that last for hundreds of orders. Reduced rank extrapolation [Smith, Ford and Sidi 1987] finds
// from d_0 ... d_k, the light of k + 1 chunks of as many orders each, the weights of sum 1 for which
//
//   c_0 d_0 + ... + c_k d_k
//
// is least; where there are but k modes it is nothing, and all later orders together are
//
//   -(c_0 d_1 + (c_0 + c_1) d_2 + ... + (c_0 + ... + c_(k-1)) d_k),
//
// for k = 1 the geometric series.

const int MOST_CHUNKS = 4;

// What later orders may be of the chunk before them. In the planet's shadow the second order may be brighter than
// the first, for a while: but a chunk has a share of the one before it that is little more than that under the
// highest sun.
const Real MORE_THAN_AT_NOON = 1.25;
Vec4 most_later_orders(Vec4 last, Vec4 later_over_last_at_noon, Vec4 largest_share) {
  Vec4 noon = later_over_last_at_noon / (later_over_last_at_noon + 1.0);
  Vec4 share = min(noon * MORE_THAN_AT_NOON, largest_share);
  return last * share / (1.0 - share);
}

// The rest is there where CHUNK_BUFFER is defined, which at CHUNK_PLACE(n, i) has value i of CHUNK_VALUES of a vector n
// that may be overwritten.
#ifdef CHUNK_BUFFER
Vec4 vector_value(int n, int i) { return READ(CHUNK_BUFFER, CHUNK_PLACE(n, i)); }
void set_vector_value(int n, int i, Vec4 value) { WRITE(CHUNK_BUFFER, CHUNK_PLACE(n, i), value); }

Vec4 product_of_vectors(int a, int b) {
  Vec4 sum = Vec4(0.0);
  for (int i = 0; i < CHUNK_VALUES; ++i) sum = sum + vector_value(a, i) * vector_value(b, i);
  return sum;
}

// Takes `share` of the vector a from b.
void subtract_vector(int a, Vec4 share, int b) {
  for (int i = 0; i < CHUNK_VALUES; ++i) {
    set_vector_value(b, i, vector_value(b, i) - vector_value(a, i) * share);
  }
}

// The weights of d_1 to d_k in all later orders, from the vectors d_n - d_k, n < k, and -d_k. With c_k = 1 - the
// others, |c_0 d_0 + ... + c_k d_k| is |d_k + sum of c_n (d_n - d_k)|: least squares by the modified Gram-Schmidt
// method, which keeps the digits that normal equations lose.
void weigh_chunks(int k, out Vec4 weights[MOST_CHUNKS]) {
  // What a vector shares with those before it, [vector][before].
  Vec4 share[MOST_CHUNKS * MOST_CHUNKS];
  for (int n = 0; n < k; ++n) {
    Vec4 square = product_of_vectors(n, n);
    for (int m = n + 1; m <= k; ++m) {
      Vec4 in_both = product_of_vectors(n, m) / max(square, Vec4(1e-30));
      share[m * MOST_CHUNKS + n] = in_both;
      subtract_vector(n, in_both, m);
    }
  }
  Vec4 c[MOST_CHUNKS];
  for (int n = k - 1; n >= 0; --n) {
    c[n] = share[k * MOST_CHUNKS + n];
    for (int m = n + 1; m < k; ++m) c[n] = c[n] - share[m * MOST_CHUNKS + n] * c[m];
  }
  weights[0] = Vec4(0.0);
  for (int n = 0; n < k; ++n) weights[n + 1] = weights[n] - c[n];
}
#endif
