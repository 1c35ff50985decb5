<!DOCTYPE qgis PUBLIC 'http://mrcc.com/qgis.dtd' 'SYSTEM'>
<qgis styleCategories="Symbology" version="3.40.0">
  <pipe>
    <rasterrenderer type="singlebandpseudocolor" band="1" classificationMin="0" classificationMax="40" alphaBand="-1" nodataColor="" opacity="1">
      <rastershader>
        <colorrampshader colorRampType="INTERPOLATED" classificationMode="1" clip="0" minimumValue="0" maximumValue="40">
          <item label="0 m" value="0" alpha="255" color="#f7f4ef"/>
          <item label="2.5 m" value="2.5" alpha="255" color="#d9d6c4"/>
          <item label="5 m" value="5" alpha="255" color="#f0c27b"/>
          <item label="10 m" value="10" alpha="255" color="#d9793f"/>
          <item label="20 m" value="20" alpha="255" color="#9e2f3a"/>
          <item label="40 m" value="40" alpha="255" color="#4a1c4e"/>
        </colorrampshader>
      </rastershader>
    </rasterrenderer>
    <resamplingStage>resamplingFilter</resamplingStage>
  </pipe>
  <blendMode>0</blendMode>
</qgis>
