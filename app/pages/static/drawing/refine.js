// Draw finer on zooming in: ask again once a zoom has come to rest.
const WAIT_MS = 250;

/**
 * Give what is called with the range that is shown, and shows finer values of it. Where every sample is there already, nothing is asked.
 * @template T
 * @param {T & {whole: boolean, extent: [number, number]}} whole what is shown of the whole range
 * @param {function([number, number]): Promise<T|null>} read gives finer values of a range; null where there are none
 * @param {function(T): void} show
 * @returns {function(number, number): void}
 */
export function refining(whole, read, show) {
  let waiting = null;
  let latest = 0;
  return (from, to) => {
    if (whole.whole) return;
    clearTimeout(waiting);
    waiting = setTimeout(async () => {
      latest += 1;
      const mine = latest;
      const all = from <= whole.extent[0] && to >= whole.extent[1];
      const found = all ? whole : await read([from, to]).catch(() => null); // what is drawn stays where nothing finer comes
      if (found !== null && mine === latest) show(found);
    }, WAIT_MS);
  };
}
