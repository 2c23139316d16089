/** Records what is drawn into a film, by the browser's own encoder. */

const TYPES = ["video/webm;codecs=vp9", "video/webm;codecs=vp8", "video/webm", "video/mp4"];

export interface Film {
  content: Blob;
  /** The end of its name. */
  ending: "webm" | "mp4";
}

/** Whether this browser can do it. */
export const canRecord = (): boolean => typeof MediaRecorder !== "undefined" && TYPES.some((type) => MediaRecorder.isTypeSupported(type));

/** Starts a film of a canvas; what it gives ends the film. */
export function record(canvas: HTMLCanvasElement): () => Promise<Film> {
  const type = TYPES.find((x) => MediaRecorder.isTypeSupported(x))!;
  const stream = canvas.captureStream(30);
  const recorder = new MediaRecorder(stream, { mimeType: type, videoBitsPerSecond: 8_000_000 });
  const parts: Blob[] = [];
  recorder.ondataavailable = ({ data }) => parts.push(data);
  recorder.start();
  return () =>
    new Promise((done) => {
      recorder.onstop = () => {
        for (const track of stream.getTracks()) track.stop();
        done({ content: new Blob(parts, { type: type.split(";")[0] }), ending: type.includes("mp4") ? "mp4" : "webm" });
      };
      recorder.stop();
    });
}
