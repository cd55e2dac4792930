import { readFileSync } from "node:fs";
import type { Plugin } from "vite";
import { defineConfig } from "vitest/config";

/// The licences of what the page bundles, word for word.
const licences = ["three", "uplot"]
  .map((name) => `${name}\n\n${readFileSync(`node_modules/${name}/LICENSE`, "utf8").trim()}`)
  .join("\n\n\n");

/// Puts script and style into the page itself, so that it is one file which opens from disk.
function oneFile(): Plugin {
  return {
    name: "one-file",
    enforce: "post",
    generateBundle(_, bundle) {
      const page = bundle["index.html"];
      if (page?.type !== "asset") {
        throw new Error("expected index.html in the bundle");
      }
      let html = String(page.source);
      for (const [name, part] of Object.entries(bundle)) {
        const text = part.type === "chunk" ? part.code : String(part.source);
        if (name.endsWith(".js")) {
          const safe = text.replaceAll("</script", "<\\/script");
          html = html
            .replace(new RegExp(`\\s*<script[^>]*src="[^"]*${name}"[^>]*></script>`), "")
            .replace("</body>", () => `<script type="module">${safe}</script>\n  </body>`);
        } else if (name.endsWith(".css")) {
          html = html.replace(
            new RegExp(`<link[^>]*href="[^"]*${name}"[^>]*>`),
            () => `<style>${text}</style>`,
          );
        } else {
          continue;
        }
        delete bundle[name];
      }
      page.source = html;
    },
  };
}

export default defineConfig({
  plugins: [oneFile()],
  define: { LICENCES: JSON.stringify(licences) },
  build: {
    target: "es2022",
    modulePreload: false,
    cssCodeSplit: false,
    assetsInlineLimit: Number.MAX_SAFE_INTEGER,
    chunkSizeWarningLimit: 2000,
    emptyOutDir: true,
    rollupOptions: { output: { inlineDynamicImports: true } },
  },
  test: { include: ["tests/**/*.test.ts"], testTimeout: 30_000, hookTimeout: 300_000 },
});
