// Answers that come in pieces: lines, and the parts of a multipart stream.

/** The connection ended in the middle. */
export class Broken extends Error {}

async function next(reader) {
  try {
    return await reader.read();
  } catch (error) {
    if (error.name === 'AbortError') throw error;
    throw new Broken();
  }
}

/** Calls `onLine` with each line of text as it comes. */
export async function readLines(body, onLine) {
  const reader = body.pipeThrough(new TextDecoderStream()).getReader();
  let rest = '';
  for (;;) {
    const { value, done } = await next(reader);
    if (done) return;
    const lines = (rest + value).split('\n');
    rest = lines.pop();
    lines.forEach(onLine);
  }
}

const HEAD_END = [13, 10, 13, 10];

/** Calls `onPart({ headers, bytes })` with each part; parts say their Content-Length. */
export async function readParts(body, onPart) {
  const source = new Source(body.getReader());
  for (;;) {
    const head = await source.until(HEAD_END);
    if (head === undefined) return;
    const headers = new Headers(new TextDecoder().decode(head).split('\r\n')
      .map((line) => line.match(/^([\w-]+): (.*)$/)).filter(Boolean).map(([, name, value]) => [name, value]));
    const bytes = await source.take(Number(headers.get('Content-Length')));
    if (bytes === undefined) return;
    await onPart({ headers, bytes });
  }
}

// Bytes of a stream, taken by length or up to a mark.
class Source {
  #held = new Uint8Array();

  constructor(reader) {
    this.reader = reader;
  }

  async until(mark) {
    let from = 0;
    for (;;) {
      for (; from + mark.length <= this.#held.length; ++from) {
        if (mark.every((byte, k) => this.#held[from + k] === byte)) return this.#cut(from + mark.length);
      }
      if (!(await this.#more())) return undefined;
    }
  }
  async take(length) {
    while (this.#held.length < length) if (!(await this.#more())) return undefined;
    return this.#cut(length);
  }

  #cut(length) {
    const bytes = this.#held.slice(0, length);
    this.#held = this.#held.subarray(length);
    return bytes;
  }
  async #more() {
    const { value, done } = await next(this.reader);
    if (done) return false;
    const joined = new Uint8Array(this.#held.length + value.length);
    joined.set(this.#held);
    joined.set(value, this.#held.length);
    this.#held = joined;
    return true;
  }
}
