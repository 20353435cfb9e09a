// SPDX-FileCopyrightText: The limen authors
// SPDX-License-Identifier: Apache-2.0

// What an independent decoder (npm laz-perf) finds in LAZ files: one line per file, as the benchmark of LAS
// prints it with --brief. Usage: node laz_perf_summary.mjs FOLDER_OF_LAZ_PERF FILE...
import { readFileSync } from "node:fs";
import { createRequire } from "node:module";
import { join } from "node:path";

const [folder, ...files] = process.argv.slice(2);
const require = createRequire(join(folder, "index.js"));
const lazPerf = await require("laz-perf").createLazPerf();

// FNV-1a in 64 bits, as four numbers of 16 bits: BigInt would take minutes.
function makeHash() {
  let [a, b, c, d] = [0x2325, 0x8422, 0x9ce4, 0xcbf2];
  return {
    add(byte) {
      a ^= byte;
      // times 2^40 + 0x1b3
      const p = a * 0x1b3;
      const q = b * 0x1b3 + Math.floor(p / 65536);
      const r = c * 0x1b3 + Math.floor(q / 65536) + ((a << 8) & 0xffffff);
      const s = d * 0x1b3 + Math.floor(r / 65536) + ((b << 8) & 0xffffff);
      [a, b, c, d] = [p % 65536, q % 65536, r % 65536, s % 65536];
    },
    text: () => [d, c, b, a].map((x) => x.toString(16).padStart(4, "0")).join(""),
  };
}

function summary(name) {
  const bytes = readFileSync(name);
  const file = lazPerf._malloc(bytes.length);
  lazPerf.HEAPU8.set(bytes, file);
  const reader = new lazPerf.LASZip();
  reader.open(file, bytes.length);
  const count = reader.getCount();
  const length = reader.getPointLength();
  const place = lazPerf._malloc(length);
  const hash = makeHash();
  const sum = [0n, 0n, 0n];
  const low = [0, 0, 0];
  const high = [0, 0, 0];
  for (let i = 0; i < count; ++i) {
    reader.getPoint(place);
    const point = lazPerf.HEAPU8.subarray(place, place + length);
    for (let k = 0; k < length; ++k) hash.add(point[k]);
    const numbers = new DataView(point.buffer, point.byteOffset, 12);
    for (let k = 0; k < 3; ++k) {
      const value = numbers.getInt32(4 * k, true);
      sum[k] += BigInt(value);
      low[k] = i === 0 ? value : Math.min(low[k], value);
      high[k] = i === 0 ? value : Math.max(high[k], value);
    }
  }
  const line = `${name} format ${reader.getPointFormat()} points ${count} hash ${hash.text()} ` +
    `sum ${sum.join(" ")} low ${low.join(" ")} high ${high.join(" ")}`;
  reader.delete();
  lazPerf._free(place);
  lazPerf._free(file);
  return line;
}

for (const name of files) {
  try {
    console.log(summary(name));
  } catch (error) {
    console.log(`${name} error ${error}`);
  }
}
