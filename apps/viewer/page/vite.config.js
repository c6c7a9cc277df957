import { defineConfig } from "vite";

// Three files of fixed names, which the program takes in. Nothing in them depends on when or where they are built.
export default defineConfig({
  base: "./",
  build: {
    outDir: "built",
    target: "es2022",
    modulePreload: false,
    chunkSizeWarningLimit: 1500,
    reportCompressedSize: false,
    rollupOptions: {
      output: {
        entryFileNames: "page.js",
        assetFileNames: (asset) => (asset.names.some((name) => name.endsWith(".css")) ? "page.css" : "[name][extname]"),
        inlineDynamicImports: true,
      },
    },
  },
});
